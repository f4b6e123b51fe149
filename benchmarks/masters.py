"""The trip of the 50 m tower under co-simulation masters that differ in their order and in what they do at initialization.

    python benchmarks/masters.py [--duration 12] [--steps 0.001 0.01 0.025] [--fmus DRIVE.fmu ROPE.fmu]

Prints for each master the displacement of the sensor `cw_low` from rest, largest and smallest, and the car's height at the end,
of drive and rope in this process or of the FMUs named.
"""

import argparse
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from comprope.drive.cosimulation import interface as drive_interface
from comprope.errors import CompropeError
from comprope.rope.model_file import load
from comprope.rope.simulator.cosimulation import interface as rope_interface
from comprope_system.presets import model_path
from comprope_system.simulation.cosim.fmu_participant import FmuParticipant
from comprope_system.simulation.cosim.in_process_participant import InProcessParticipant
from comprope_system.simulation.trips.elevator import BACKWARD, FORWARD

SENSOR = "lateral_displacement[1]"
ORDERS = ("drive first", "rope first", "both at once")
PROPAGATED = ("all", "positions", "nothing")
Values = dict[str, Any]
Participants = tuple[Any, Any]
Maker = Callable[[Values, Values], Any]


def passed(outputs: Values, connections: Any) -> Values:
    """The inputs that connections make of outputs."""
    return {one.input: outputs[one.output] for one in connections}


@contextmanager
def in_this_process(motion: Values, rope: Values) -> Iterator[Participants]:
    """Drive and rope of this package, with values by name."""
    yield (
        InProcessParticipant("motion", drive_interface(), motion),
        InProcessParticipant("rope", rope_interface(load(model_path("tower50"))), rope),
    )


def in_fmus(drive_fmu: Path, rope_fmu: Path) -> Maker:
    """The same of FMUs."""

    @contextmanager
    def participants(motion: Values, rope: Values) -> Iterator[Participants]:
        with ExitStack() as stack:
            yield (
                stack.enter_context(FmuParticipant("motion", drive_fmu, motion)),
                stack.enter_context(FmuParticipant("rope", rope_fmu, rope)),
            )

    return participants


def initialize(drive: Any, rope: Any, propagates: str) -> None:
    """Initialize both, with the connections propagated or not."""
    for one in (drive, rope):
        one.enter_initialization(0.0)
    if propagates in ("all", "positions"):
        rope.set(passed(drive.outputs(), FORWARD))
    if propagates == "all":
        drive.set(passed(rope.outputs(), BACKWARD))
    for one in (drive, rope):
        one.exit_initialization()


def advance(drive: Any, rope: Any, order: str, time: float, step: float, unknown: bool) -> None:
    """One communication step [s]; at first the tensions may be unknown to a master that has propagated nothing."""
    forward = passed(drive.outputs(), FORWARD)
    if order == "rope first":
        rope.set(forward)
        rope.step(time, step)
    if not unknown or order != "drive first":
        drive.set(passed(rope.outputs(), BACKWARD))
    drive.step(time, step)
    if order != "rope first":
        rope.set(passed(drive.outputs(), FORWARD) if order == "drive first" else forward)
        rope.step(time, step)


def trip(
    order: str, propagates: str, start: float, duration: float, step: float, make: Maker = in_this_process
) -> tuple[float, float, float]:
    """Largest and smallest displacement from rest [mm], and the car's height at the end [m]."""
    motion = {"trip.start_position": start, "trip.destination": 50.0}
    switches = {"derivative_inputs": True, "inputs_at_end": order == "drive first"}
    with make(motion, switches) as (drive, rope):
        initialize(drive, rope, propagates)
        first, seen = rope.outputs()[SENSOR], [0.0]
        for count in range(round(duration / step)):
            advance(drive, rope, order, count * step, step, unknown=count == 0 and propagates != "all")
            seen.append(1e3 * (rope.outputs()[SENSOR] - first))
        return max(seen), min(seen), drive.outputs()["car_position"]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--duration", type=float, default=12.0, metavar="S")
    parser.add_argument("--steps", type=float, nargs="+", default=[0.01], metavar="S")
    parser.add_argument("--starts", type=float, nargs="+", default=[0.0, 10.0], metavar="M")
    parser.add_argument("--fmus", type=Path, nargs=2, metavar=("DRIVE", "ROPE"))
    options = parser.parse_args()
    make = in_fmus(*options.fmus) if options.fmus else in_this_process
    print("| order | propagated at initialization | start | step [ms] | cw_low from rest [mm] | car at the end [m] |")
    print("|---|---|---|---|---|---|")
    for start in options.starts:
        for order in ORDERS:
            for propagates in PROPAGATED:
                for step in options.steps:
                    try:
                        high, low, car = trip(order, propagates, start, options.duration, step, make)
                        found = f"{high:.4f} to {low:.4f} | {car:.7f}"
                    except CompropeError as error:
                        found = f"refused: {error} | "
                    print(f"| {order} | {propagates} | {start:g} m | {1e3 * step:g} | {found} |", flush=True)


if __name__ == "__main__":
    main()
