"""Long test of an FMU, a day of random trips: memory, energy residual and failures.

    python benchmarks/soak.py dist/CompensationRope_native.fmu [--drive dist/ElevatorDrive_native.fmu] [--hours 24] [--step 0.02]
        [--element 0.05] [--seed 1]

The car of the 50 m tower goes from landing to landing, at least 3 m, with 2.5 m/s, 0.8 m/s2 and 0.8 m/s3 at most, waits up
to 20 s, and goes on, at random: on a prescribed motion, or called by the drive's input and moved by its FMU, coupled drive first.
Exchanged is the energy that passes the car's end of the rope either way.
"""

import argparse
import itertools
import random
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import TrajectoryPoint, plan_s_curve

HEIGHT, WAIT = 50.0, 20.0  # m, s
LANDINGS = [HEIGHT - 3.0 * k for k in range(17)] + [0.0]  # m
INPUTS = [f"{end}_{what}" for end in ("car", "counterweight") for what in ("position", "velocity", "acceleration")]
SHOWN = ("energy_residual", "sheave_displacement", "car_end_tension")
TENSIONS = ("car_end_tension", "counterweight_end_tension")
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


class Slave:
    """An instance ready to step, whose values have names."""

    def __init__(self, path: str, reals: dict[str, float], switches: tuple[str, ...] = ()) -> None:
        description = read_model_description(path)
        self.places = {one.name: one.valueReference for one in description.modelVariables}
        name = description.coSimulation.modelIdentifier
        self.fmu = FMU2Slave(guid=description.guid, unzipDirectory=extract(path), modelIdentifier=name, instanceName="soak")
        self.fmu.instantiate()
        self.fmu.setupExperiment(startTime=0.0)
        self.set(reals)
        self.fmu.setBoolean([self.places[name] for name in switches], [True] * len(switches))
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def set(self, values: dict[str, float]) -> None:
        """Set real values."""
        self.fmu.setReal([self.places[name] for name in values], list(values.values()))

    def get(self, names: Sequence[str]) -> list[float]:
        """Read real values."""
        return list(self.fmu.getReal([self.places[name] for name in names]))


def prescribed(step: float, generator: random.Random) -> Iterator[tuple[int, dict[str, float]]]:
    """Number of the trip, and the inputs of the rope at the end of every communication step."""
    for number, motion in car(step, generator):
        x, v, a = motion.position, motion.velocity, motion.acceleration
        yield number, dict(zip(INPUTS, (x, v, a, HEIGHT - x, -v, -a), strict=True))


def driven(drive: Slave, rope: Slave, step: float, generator: random.Random) -> Iterator[tuple[int, dict[str, float]]]:
    """The same of a drive that is called at random and carries the rope."""
    number, call, destination = 1, 0.0, 0.0
    for count in itertools.count():
        now = count * step
        if now >= call:
            others = [one for one in LANDINGS if one != destination]
            destination, number = generator.choice(others), number + 1
            call = now + 5.0 + HEIGHT / 2.5 + generator.uniform(0.0, WAIT)  # s, enough for any trip
        drive.set(dict(zip(("destination", *TENSIONS), (destination, *rope.get(TENSIONS)), strict=True)))
        drive.fmu.doStep(now, step)
        yield number, dict(zip(INPUTS, drive.get(INPUTS), strict=True))


def soak(rope: Slave, motion: Iterator[tuple[int, dict[str, float]]], options: argparse.Namespace) -> None:
    """Simulate, and print a line for each simulated hour."""
    step, exchanged, slowest = options.step, 0.0, 0.0
    begin, per_hour = time.perf_counter(), round(3600.0 / step)
    for count, (number, inputs) in enumerate(motion, 1):
        rope.set(inputs)
        started = time.thread_time()
        rope.fmu.doStep((count - 1) * step, step)
        slowest = max(slowest, time.thread_time() - started)
        residual, sheave, tension = rope.get(SHOWN)
        exchanged += abs(tension * inputs["car_velocity"]) * step
        if count % per_hour == 0:
            hour, halved = count // per_hour, rope.fmu.getInteger([rope.places["halvings"]])[0]
            numbers = f"{exchanged / 1e6:.2f} MJ | {residual:.3g} J | {1e3 * sheave:.3f} mm | {halved} | {1e3 * slowest:.1f} ms"
            print(f"| {hour} | {number} | {resident():.1f} MB | {numbers} | {time.perf_counter() - begin:.0f} s |", flush=True)
            if hour >= options.hours:
                return


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmu")
    parser.add_argument("--drive", metavar="FMU")
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--step", type=float, default=0.02)
    parser.add_argument("--element", type=float, default=0.05)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    generator = random.Random(options.seed)
    rope = Slave(options.fmu, {"rope.element_length": options.element}, ("derivative_inputs", "inputs_at_end"))
    slaves, motion = [rope], prescribed(options.step, generator)
    if options.drive:
        drive = Slave(options.drive, {"trip.destination": 0.0})
        slaves, motion = [drive, rope], driven(drive, rope, options.step, generator)
    print("| hour | trips | memory | exchanged | energy residual | sheave | halvings | slowest step | took |")
    print("|---|---|---|---|---|---|---|---|---|")
    soak(rope, motion, options)
    for one in slaves:
        one.fmu.terminate()
        one.fmu.freeInstance()


if __name__ == "__main__":
    main()
