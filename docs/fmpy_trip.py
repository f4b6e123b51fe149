"""Co-simulation with fmpy: `python docs/fmpy_trip.py dist/ElevatorDrive.fmu dist/CompensationRope.fmu trip.csv`.

The drive steps first, with the tensions of the rope after the previous step; then the rope, with the motion of the drive in
this step. The optional fourth argument is the simulated time [s].
"""

import csv
import shutil
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

STEP = 0.01  # s
MOTIONS = [f"{end}_{what}" for end in ("car", "counterweight") for what in ("position", "velocity", "acceleration")]
TENSIONS = ["car_end_tension", "counterweight_end_tension"]
SHOWN = ["lateral_displacement[1]", "sheave_displacement", "sheave_force"]


class Part:
    """One FMU instance with access by variable names."""

    def __init__(self, path: str, name: str) -> None:
        description = read_model_description(path)
        self.references = {one.name: one.valueReference for one in description.modelVariables}
        self.folder = extract(path)
        self.fmu = FMU2Slave(
            guid=description.guid, unzipDirectory=self.folder, instanceName=name,
            modelIdentifier=description.coSimulation.modelIdentifier,
        )  # fmt: skip
        self.fmu.instantiate()
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()

    def set(self, values: Mapping[str, float]) -> None:
        """Set real parameters before the start, real inputs at any time."""
        self.fmu.setReal([self.references[name] for name in values], list(values.values()))

    def switch(self, names: Iterable[str]) -> None:
        """Set Boolean parameters true."""
        for name in names:
            self.fmu.setBoolean([self.references[name]], [True])

    def get(self, names: Iterable[str]) -> dict[str, float]:
        """Real outputs."""
        chosen = list(names)
        return dict(zip(chosen, self.fmu.getReal([self.references[name] for name in chosen]), strict=True))

    def close(self) -> None:
        """Terminate and free the instance."""
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


def main(drive_path: str, rope_path: str, out: str, duration: str = "33") -> None:
    """Simulate the first trip of the drive and write the results as CSV."""
    drive, rope = Part(drive_path, "drive"), Part(rope_path, "rope")
    # The inputs of the rope are the drive's motion at the end of the step, with velocities and accelerations.
    rope.switch(["inputs_at_end", "derivative_inputs"])
    for _ in range(2):  # the static tensions depend on the positions of the ends, and are inputs of the drive
        rope.set(drive.get(MOTIONS))
        drive.set(rope.get(TENSIONS))
    for part in (drive, rope):
        part.fmu.exitInitializationMode()
    rows = [row(0.0, drive, rope)]
    for count in range(round(float(duration) / STEP)):
        time = count * STEP
        drive.set(rope.get(TENSIONS))
        drive.fmu.doStep(time, STEP)
        rope.set(drive.get(MOTIONS))
        rope.fmu.doStep(time, STEP)
        rows.append(row(time + STEP, drive, rope))
    for part in (drive, rope):
        part.close()
    with Path(out).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["time", "car_position", *SHOWN])
        writer.writerows(rows)


def row(time: float, drive: Part, rope: Part) -> list[float]:
    """One row of results."""
    return [round(time, 9), *drive.get(["car_position"]).values(), *rope.get(SHOWN).values()]


if __name__ == "__main__":
    main(*sys.argv[1:])
