"""Long test of an FMU, a day of random trips: memory, energy residual and failures.

    python benchmarks/soak.py dist/CompensationRope_native.fmu [--hours 24] [--step 0.02] [--element 0.05] [--seed 1]

The car of the 50 m tower goes from landing to landing, at least 3 m, with 2.5 m/s, 0.8 m/s2 and 0.8 m/s3 at most, waits up
to 20 s, and goes on, at random. Exchanged is the energy that passes the car's end of the rope either way.
"""

import argparse
import random
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import TrajectoryPoint, plan_s_curve

HEIGHT, WAIT = 50.0, 20.0  # m, s
LANDINGS = [HEIGHT - 3.0 * k for k in range(17)] + [0.0]  # m
INPUTS = [f"{end}_{what}" for end in ("car", "counterweight") for what in ("position", "velocity", "acceleration")]
SHOWN = ("energy_residual", "sheave_displacement", "car_end_tension")
PAGE = 4096 / 1e6  # MB


def car(step: float, generator: random.Random) -> Iterator[tuple[int, TrajectoryPoint]]:
    """Number of the trip and motion of the car at the end of every communication step."""
    count, number, trip = 0, 1, plan_s_curve(Profile(), 0.0, generator.choice(LANDINGS[:-1]), 1.0)
    while True:
        count += 1
        if count * step > trip.end_time:
            others = [one for one in LANDINGS if one != trip.destination]
            begin = count * step + generator.uniform(0.0, WAIT)
            number, trip = number + 1, plan_s_curve(Profile(), trip.destination, generator.choice(others), begin)
        yield number, trip.at(count * step)


def resident() -> float:
    """Memory of this process [MB]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE


def begun(path: str, element: float) -> tuple[Any, dict[str, int]]:
    """An instance ready to step, and its value references by name."""
    description = read_model_description(path)
    places = {one.name: one.valueReference for one in description.modelVariables}
    name = description.coSimulation.modelIdentifier
    slave = FMU2Slave(guid=description.guid, unzipDirectory=extract(path), modelIdentifier=name, instanceName="soak")
    slave.instantiate()
    slave.setupExperiment(startTime=0.0)
    slave.setReal([places["rope.element_length"]], [element])
    slave.setBoolean([places["derivative_inputs"], places["inputs_at_end"]], [True, True])
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    return slave, places


def soak(slave: Any, places: dict[str, int], options: argparse.Namespace) -> None:
    """Simulate, and print a line for each simulated hour."""
    step, exchanged, slowest = options.step, 0.0, 0.0
    inputs, shown = [places[name] for name in INPUTS], [places[name] for name in SHOWN]
    begin, per_hour = time.perf_counter(), round(3600.0 / step)
    for count, (number, motion) in enumerate(car(step, random.Random(options.seed)), 1):
        x, v, a = motion.position, motion.velocity, motion.acceleration
        slave.setReal(inputs, [x, v, a, HEIGHT - x, -v, -a])
        started = time.thread_time()
        slave.doStep((count - 1) * step, step)
        slowest = max(slowest, time.thread_time() - started)
        residual, sheave, tension = slave.getReal(shown)
        exchanged += abs(tension * v) * step
        if count % per_hour == 0:
            hour, halved = count // per_hour, slave.getInteger([places["halvings"]])[0]
            numbers = f"{exchanged / 1e6:.2f} MJ | {residual:.3g} J | {1e3 * sheave:.3f} mm | {halved} | {1e3 * slowest:.1f} ms"
            print(f"| {hour} | {number} | {resident():.1f} MB | {numbers} | {time.perf_counter() - begin:.0f} s |", flush=True)
            if hour >= options.hours:
                return


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmu")
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--step", type=float, default=0.02)
    parser.add_argument("--element", type=float, default=0.05)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    slave, places = begun(options.fmu, options.element)
    print("| hour | trips | memory | exchanged | energy residual | sheave | halvings | slowest step | took |")
    print("|---|---|---|---|---|---|---|---|---|")
    soak(slave, places, options)
    slave.terminate()
    slave.freeInstance()


if __name__ == "__main__":
    main()
