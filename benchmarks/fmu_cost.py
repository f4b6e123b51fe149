"""Processor seconds per simulated second of the rope's FMUs through fmpy, on the 45 m trip in the 50 m tower.

    python benchmarks/fmu_cost.py dist/CompensationRope_native.fmu dist/CompensationRope.fmu [--runs 3]

All real outputs are read every 20 ms. The model without an FMU around it comes last. Of several runs the cheapest counts.
"""

import argparse
import time
from pathlib import Path

from realtime import Ride, direct, through_fmu

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import TrajectoryPoint, plan_s_curve
from comprope.fmi.model_interface import ModelInterface
from comprope.rope.model_file import load, with_changes
from comprope.rope.simulator.cosimulation import interface
from comprope_system import presets

DT, SECONDS, HEIGHT = 0.02, 24.0, 50.0
INPUTS = [f"{end}_{what}" for what in ("position", "velocity", "acceleration") for end in ("car", "counterweight")]


def ends(car: TrajectoryPoint) -> list[float]:
    """Inputs of the rope while the counterweight mirrors the car."""
    return [car.position, HEIGHT - car.position, car.velocity, -car.velocity, car.acceleration, -car.acceleration]


def ride_of(path: str | None, model: ModelInterface) -> Ride:
    """Steps of an FMU, or without a path of the model itself."""
    return direct(model, INPUTS, DT) if path is None else through_fmu(path, model, INPUTS, DT)


def cost(ride: Ride) -> float:
    """CPU seconds per simulated second."""
    trip = plan_s_curve(Profile(), 0.0, 45.0, 1.0)
    began = time.process_time()
    for count in range(round(SECONDS / DT)):
        ride(count * DT, ends(trip.at((count + 1) * DT)))
    return (time.process_time() - began) / SECONDS


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmus", nargs="*", metavar="FMU")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    print("| run by | size | CPU s/s at 1 ms | at 4 ms |\n|---|---|---|---|")
    models = [interface(with_changes(load(presets.model_path("tower50")), {"solver.step": step})) for step in (0.001, 0.004)]
    for path in [*options.fmus, None]:
        costs = [min(cost(ride_of(path, model)) for _ in range(options.runs)) for model in models]
        name, size = (Path(path).stem, f"{Path(path).stat().st_size / 1e3:.0f} kB") if path else ("directly", "")
        print(f"| {name} | {size} | {' | '.join(f'{one:.3f}' for one in costs)} |", flush=True)


if __name__ == "__main__":
    main()
