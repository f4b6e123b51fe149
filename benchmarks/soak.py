"""A day of random trips through an FMU: is memory bounded, does the energy ledger close, does anything fail?

    python benchmarks/soak.py dist/CompensationRope-native.fmu [--hours 24] [--step 0.02] [--element 0.1] [--seed 1]

The car of the 50 m tower goes from landing to landing at 2.5 m/s, waits, and goes on, at random.
"""

import argparse
import math
import random
import time
from collections.abc import Iterator
from pathlib import Path

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

HEIGHT, SPEED, WAIT = 50.0, 2.5, 20.0  # m, m/s, s
PAGE = 4096 / 1e6  # MB


def car_positions(step: float, generator: random.Random) -> Iterator[float]:
    """Height of the car at every communication step: half cosines between landings, with pauses."""
    at = 0.0
    while True:
        to = generator.uniform(0.0, HEIGHT)
        count = max(1, round(math.pi * abs(to - at) / (2.0 * SPEED) / step))
        for k in range(1, count + 1):
            yield at + 0.5 * (to - at) * (1.0 - math.cos(math.pi * k / count))
        at = to
        for _ in range(round(generator.uniform(0.0, WAIT) / step)):
            yield at


def resident() -> float:
    """Memory of this process [MB]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE


def main() -> None:
    """Run, with a line for each simulated hour."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmu")
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--step", type=float, default=0.02)
    parser.add_argument("--element", type=float, default=0.1)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    description = read_model_description(options.fmu)
    places = {one.name: one.valueReference for one in description.modelVariables}
    name = description.coSimulation.modelIdentifier
    slave = FMU2Slave(guid=description.guid, unzipDirectory=extract(options.fmu), modelIdentifier=name, instanceName="soak")
    slave.instantiate()
    slave.setupExperiment(startTime=0.0)
    slave.setReal([places["rope.element_length"]], [options.element])
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    ends = [places["car_position"], places["counterweight_position"]]
    shown = [places["energy_residual"], places["sheave_displacement"]]
    begin, per_hour = time.perf_counter(), round(3600.0 / options.step)
    print("| hour | memory | energy residual | sheave | halvings | took |\n|---|---|---|---|---|---|")
    for count, car in enumerate(car_positions(options.step, random.Random(options.seed))):
        slave.setReal(ends, [car, HEIGHT - car])
        slave.doStep(count * options.step, options.step)
        if (count + 1) % per_hour == 0:
            residual, sheave = slave.getReal(shown)
            halved = slave.getInteger([places["halvings"]])[0]
            hour, took = (count + 1) // per_hour, time.perf_counter() - begin
            moved = f"{1e3 * sheave:.3f} mm"
            print(f"| {hour} | {resident():.1f} MB | {residual:.3g} J | {moved} | {halved} | {took:.0f} s |", flush=True)
            if hour >= options.hours:
                break
    slave.terminate()
    slave.freeInstance()


if __name__ == "__main__":
    main()
