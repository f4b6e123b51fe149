"""Processor seconds per simulated second of the rope's FMU through fmpy, on the 45 m trip in the 50 m tower.

python benchmarks/fmu_cost.py
"""

import time

from comprope.drive.parameters import Profile
from comprope.drive.trajectory import Motion, plan
from comprope_system.cosim.fmu import FmuParticipant
from comprope_system.cosim.fmus import rope_fmu

DT, SECONDS, HEIGHT = 0.02, 24.0, 50.0


def ends(car: Motion) -> dict[str, float]:
    """Inputs of the rope while the counterweight mirrors the car."""
    values = {"car_position": car.position, "counterweight_position": HEIGHT - car.position}
    for word, value in (("velocity", car.velocity), ("acceleration", car.acceleration)):
        values |= {f"car_{word}": value, f"counterweight_{word}": -value}
    return values


def cost(step: float) -> float:
    """CPU seconds per simulated second, all outputs read every 20 ms, with time steps of `step` [s]."""
    trip = plan(Profile(), 0.0, 45.0, 1.0)
    start = {"solver.step": step, "inputs_at_end": True, "derivative_inputs": True}
    with FmuParticipant("rope", rope_fmu(4), start) as rope:
        rope.prepare(0.0)
        rope.begin()
        began = time.process_time()
        for k in range(round(SECONDS / DT)):
            rope.set(ends(trip.at((k + 1) * DT)))
            rope.step(k * DT, DT)
            rope.outputs()
        return (time.process_time() - began) / SECONDS


if __name__ == "__main__":
    for step in (0.001, 0.004):
        print(f"step {1e3 * step:g} ms: {cost(step):.3f} CPU s/s")
