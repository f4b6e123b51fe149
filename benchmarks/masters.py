"""The trip of the 50 m tower under co-simulation masters that differ in their order and in what they do at initialization.

    python benchmarks/masters.py [--duration 12] [--step 0.01]

Prints for each master the displacement of the sensor `cw_low` from rest, largest and smallest, and the car's height at the end.
"""

import argparse
from typing import Any

from comprope.drive.cosimulation import interface as drive_interface
from comprope.errors import CompropeError
from comprope.rope.model_file import load
from comprope.rope.simulator.cosimulation import interface as rope_interface
from comprope_system.cosim.in_process_participant import InProcessParticipant
from comprope_system.presets import model_path
from comprope_system.simulation.elevator import BACKWARD, FORWARD

SENSOR = "lateral_displacement[1]"


def passed(outputs: dict[str, Any], connections: Any) -> dict[str, Any]:
    """The inputs that connections make of outputs."""
    return {one.input: outputs[one.output] for one in connections}


def trip(order: str, propagates: str, start: float, duration: float, step: float) -> tuple[float, float, float]:
    """Largest and smallest displacement from rest [mm], and the car's height at the end [m]."""
    drive = InProcessParticipant("motion", drive_interface(), {"trip.start_position": start, "trip.destination": 50.0})
    rope = InProcessParticipant("rope", rope_interface(load(model_path("tower50"))), {"derivative_inputs": True})
    rope.set({"inputs_at_end": order == "drive first"})
    if propagates in ("all", "positions"):
        rope.set(passed(drive.outputs(), FORWARD))
    if propagates == "all":
        drive.set(passed(rope.outputs(), BACKWARD))
    for one in (drive, rope):
        one.exit_initialization()
    first, seen = rope.outputs()[SENSOR], [0.0]
    for count in range(round(duration / step)):
        forward = passed(drive.outputs(), FORWARD)
        if count or propagates == "all" or order != "drive first":
            drive.set(passed(rope.outputs(), BACKWARD))
        drive.step(count * step, step)
        rope.set(passed(drive.outputs(), FORWARD) if order == "drive first" else forward)
        rope.step(count * step, step)
        seen.append(1e3 * (rope.outputs()[SENSOR] - first))
    return max(seen), min(seen), drive.outputs()["car_position"]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--duration", type=float, default=12.0, metavar="S")
    parser.add_argument("--step", type=float, default=0.01, metavar="S")
    options = parser.parse_args()
    print("| order | propagated at initialization | start | cw_low from rest [mm] | car at the end [m] |\n|---|---|---|---|---|")
    for start in (0.0, 10.0):
        for order in ("drive first", "both at once"):
            for propagates in ("all", "positions", "nothing"):
                try:
                    high, low, car = trip(order, propagates, start, options.duration, options.step)
                    found = f"{high:.3f} to {low:.3f} | {car:.6f}"
                except CompropeError as error:
                    found = f"refused: {error} | "
                print(f"| {order} | {propagates} | {start:g} m | {found} |", flush=True)


if __name__ == "__main__":
    main()
