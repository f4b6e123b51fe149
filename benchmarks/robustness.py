"""Robustness of the FMUs: random calls, and parameters at the corners of their ranges.

    python benchmarks/robustness.py dist/CompensationRope*.fmu dist/ElevatorDrive_native*.fmu [--calls 100000] [--corners 2000]

Random calls are compared with the model run without an FMU: the rope bit for bit, the native drive to nine digits. Each set of
corner values must run half a second or be refused with a sentence; the table counts the sentences.
"""

import argparse
import random
import sys
import time
from collections import Counter
from pathlib import Path

from fmpy import read_model_description
from fmpy.fmi1 import FMICallException

sys.path.insert(0, str(Path(__file__).parent.parent))
from tests.fmi3_pair import Pair3
from tests.fmi_pair import SMALL, Pair, random_call
from tests.native_fmu import drive, tower
from tests.test_native_drive import SMALL as SMALL_DRIVE
from tests.test_native_drive import DrivePair, DrivePair3
from tests.test_native_drive import random_call as random_drive_call

_MESH = ("shaft.height", "shaft.pit", "rope.element_length", "solver.step", "sheave.radius", "shaft.gravity")
_LOW = {"shaft.height": 10.0, "rope.element_length": 0.1}
_PAGE = 4096 / 1e6  # MB


def pair_of(path: str) -> Pair:
    """The FMU paired with the model."""
    description = read_model_description(path)
    newer = description.fmiVersion == "3.0"
    if description.modelName == "ElevatorDrive":
        return (DrivePair3 if newer else DrivePair)(Path(path), drive())
    return (Pair3 if newer else Pair)(Path(path), tower())


def calls(path: str, count: int) -> None:
    """Random calls; one disagreement ends it with an `AssertionError`."""
    pair, generator = pair_of(path), random.Random(2024)
    call, small = (random_drive_call, SMALL_DRIVE) if isinstance(pair, DrivePair) else (random_call, SMALL)
    pair.start(small)
    memory, begin = [], time.perf_counter()
    while pair.calls < count:
        call(pair, generator)
        if pair.calls % (count // 10) < 3:
            memory.append(int(Path("/proc/self/statm").read_text().split()[1]) * _PAGE)
    took = time.perf_counter() - begin
    print(f"| {Path(path).stem} | {pair.calls} calls, {pair.refusals} of them refused | {took:.0f} s | "
          f"memory {memory[len(memory) // 5]:.0f} to {memory[-1]:.0f} MB |", flush=True)  # fmt: skip
    pair.free()


def corners(path: str, count: int) -> None:
    """Every parameter alone at both ends of its range, then several at once."""
    pair, generator = pair_of(path), random.Random(5)
    low = {} if isinstance(pair, DrivePair) else _LOW
    parameters = pair.oracle.interface.of_role("parameter")
    chosen = [one for one in parameters if one.kind == "real" and not one.name.startswith("sensors")]
    tried = [{one.name: float(end)} for one in chosen for end in (one.minimum or 0.0, one.maximum or 0.0)]
    mixed = [one for one in chosen if one.name not in _MESH]
    while len(tried) < count:
        some = generator.sample(mixed, generator.choice((2, 3, 5)))
        tried.append(low | {one.name: float(generator.choice((one.minimum, one.maximum)) or 0.0) for one in some})
    found = Counter(outcome(pair, values) for values in tried[:count])
    for what, times in found.most_common():
        print(f"| {Path(path).stem} | {what} | {times} |", flush=True)
    pair.free()


def outcome(pair: Pair, values: dict[str, float]) -> str:
    """The outcome of half a second with these values: "ran", or the refusal without its numbers.

    A drive runs for two and a half seconds from the start of its trip, is tripped after one and a half by brake or safety gear.
    """
    instance, places, height = pair.instance, pair.references, values.get("shaft.height", 50.0)
    ends = [] if isinstance(pair, DrivePair) else [places["car_position"], places["counterweight_position"]]
    driven = isinstance(pair, DrivePair)
    step, values = (0.05, {"trip.start_time": 0.0} | values) if driven else (0.01, values)
    level = places[("brake", "safety_gear")[len(repr(values)) % 2]] if driven else 0
    try:
        instance.reset()
        instance.setupExperiment(startTime=0.0)
        instance.setReal([places[name] for name in values], list(values.values()))
        instance.setReal(ends, [0.0, height][: len(ends)])
        instance.enterInitializationMode()
        instance.exitInitializationMode()
        for count in range(50):
            car = 0.5 * (0.01 * count) ** 2
            instance.setReal(ends, [car, height - car][: len(ends)])
            if driven and count == 30:
                instance.setReal([level], [1.0])
            instance.doStep(step * count, step)
    except FMICallException:
        sentence = pair.messages[-1].split(" s: ", 1)[-1]
        return "refused: " + sentence.split(" = ")[0].split(" with ")[0].split(" at t")[0]
    return "ran"


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmus", nargs="+", metavar="FMU")
    parser.add_argument("--calls", type=int, default=100_000)
    parser.add_argument("--corners", type=int, default=2000)
    options = parser.parse_args()
    for path in options.fmus:
        calls(path, options.calls)
    for path in options.fmus:
        corners(path, options.corners)


if __name__ == "__main__":
    main()
