"""Drive, building and rope as three FMUs in fmpy: `python docs/examples/building_trip.py DRIVE.fmu ROPE.fmu ground.csv trip.csv`.

Builds the building's FMU from building_fmu.py and the record `ground.csv` (columns `time` [s], `ground_acceleration` [m/s2]),
then steps the drive, the building and the rope, each with what the one before it has found for the end of the step. The optional
fifth argument is the simulated time [s].
"""

import csv
import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from fmpy_trip import MOTIONS, SHOWN, STEP, TENSIONS, Part  # noqa: E402, the script beside this folder
from pythonfmu.builder import FmuBuilder  # noqa: E402

POSITIONS = ["car_position", "counterweight_position"]
SWAY = ["car_lateral_displacement", "counterweight_lateral_displacement", "base_acceleration"]


def build(record: str, folder: Path) -> Path:
    """The building's FMU with a record in it."""
    packed = folder / "ground.csv"
    shutil.copyfile(record, packed)
    return Path(FmuBuilder.build_FMU(HERE / "building_fmu.py", dest=folder, project_files=[packed]))


def simulate(drive: Part, building: Part, rope: Part, duration: float) -> list[list[float]]:
    """Rows of time, position of the car, displacement of the rope's end under it, and outputs of the rope."""
    rope.switch(["inputs_at_end", "derivative_inputs"])
    for _ in range(2):  # the static tensions depend on the positions of the ends, and are inputs of the drive
        motion = drive.get(MOTIONS)
        building.set({name: motion[name] for name in POSITIONS})
        rope.set(motion | building.get(SWAY))
        drive.set(rope.get(TENSIONS))
    for part in (drive, building, rope):
        part.fmu.exitInitializationMode()
    rows = [_row(0.0, drive, building, rope)]
    for count in range(round(duration / STEP)):
        time = count * STEP
        drive.set(rope.get(TENSIONS))
        drive.fmu.doStep(time, STEP)
        motion = drive.get(MOTIONS)
        building.set({name: motion[name] for name in POSITIONS})
        building.fmu.doStep(time, STEP)
        rope.set(motion | building.get(SWAY))
        rope.fmu.doStep(time, STEP)
        rows.append(_row(time + STEP, drive, building, rope))
    return rows


def _row(time: float, drive: Part, building: Part, rope: Part) -> list[float]:
    shown = rope.get(SHOWN)
    return [round(time, 9), *drive.get(POSITIONS[:1]).values(), *building.get(SWAY[:1]).values(), *shown.values()]


def main(drive_path: str, rope_path: str, record: str, out: str, duration: str = "20") -> None:
    """Build the building, simulate all three and write the results as CSV."""
    with TemporaryDirectory() as folder:
        parts = [Part(drive_path, "drive"), Part(str(build(record, Path(folder))), "building"), Part(rope_path, "rope")]
        rows = simulate(*parts, float(duration))
        for part in parts:
            part.close()
    with Path(out).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["time", "car_position", "car_lateral_displacement", *SHOWN])
        writer.writerows(rows)


if __name__ == "__main__":
    main(*sys.argv[1:])
