"""What raw logger files hold: the car, the columns that are channels, their noise at rest, and the travel of each run."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError
from comprope.rope.effects import RopeModel

from ..measurements.campaign_file import MotionColumn, Reading, RunSpec
from ..measurements.columns.column_names import COUNTERWEIGHT_NAMES, car_column, is_time_name, plain_name
from ..measurements.columns.signal_faults import CHANNEL_RULES
from ..measurements.files.file_format import FileFormat
from ..measurements.files.raw_table import RawColumn, printable
from ..measurements.motion.recover import recover_trip
from ..measurements.motion.trip import Trip
from ..measurements.motion_column import MotionSignal, read_motion
from ..measurements.run_files import RunFiles, Samples

Floats = NDArray[np.float64]

FEWEST = 20  # samples at rest for an estimate of the noise
SHORTEST_TRIP = 1.0  # m that a column must reach to be taken for the car's position by its values
ONE_WAY = 0.9  # share of its reach between the first and the last position of such a column
MAD_FACTOR = 1.4826  # standard deviation over median absolute deviation of a normal distribution


@dataclass(frozen=True)
class SurveyedRun:
    """One file: the motion of the car, its trip, the samples of each further column of numbers, and the assumed unit of time."""

    file: str
    car: MotionSignal
    trip: Trip | None
    samples: dict[str, Samples]
    columns: dict[str, RawColumn]
    time_unit: str | None
    remarks: tuple[str, ...]

    @property
    def travel(self) -> float:
        """Distance between the lowest and the highest position [m]; 0 for a car whose position is not measured."""
        return float(np.nanmax(self.car.value) - np.nanmin(self.car.value)) if self.car.quantity == "position" else 0.0

    def speed(self, time: Floats) -> Floats:
        """Velocity of the car [m/s] at `time` (n,) [s]."""
        if self.trip is not None:
            return self.trip.velocity(time)
        if self.car.quantity == "speed":
            return np.interp(time, self.car.time, np.nan_to_num(self.car.value))
        return np.zeros(len(time))

    @property
    def rest(self) -> float:
        """Time at rest before the trip [s]."""
        return max(self.trip.rest_before - float(self.car.time[0]), 0.0) if self.trip is not None else 0.0


def survey(folder: Path, files: Sequence[str], model: RopeModel, car: MotionColumn) -> list[SurveyedRun]:
    """The content of files in `folder`; raises `InputError` with one line for each that holds no motion of a car."""
    found, problems = [], []
    for file in files:
        try:
            found.append(_run(folder, file, model, car))
        except InputError as error:
            problems += str(error).splitlines()
    if problems:
        raise InputError("\n".join(problems))
    return found


def _run(folder: Path, file: str, model: RopeModel, stated: MotionColumn) -> SurveyedRun:
    files = RunFiles(folder, RunSpec(file=file), FileFormat(), folder)
    table = files.table(file)
    if not car_column(table) and not car_column(table, COUNTERWEIGHT_NAMES):
        stated = MotionColumn(column=_car_by_values(files, file, model.shaft.height))
    car = _car(files, stated, model.shaft.height)
    samples, columns = {}, {}
    for column in files.table(file).columns:
        if column.name == car.column or is_time_name(column.name):
            continue
        try:
            samples[column.name] = files.samples(column, file, Reading(), CHANNEL_RULES)
        except InputError:
            continue  # a column of texts
        columns[column.name] = column
    try:
        trip = recover_trip(car.time, car.value) if car.quantity == "position" else None
    except InputError:
        trip = None
    unit = files.assumed_unit if files.assumed_unit != "s" else None
    return SurveyedRun(file, car, trip, samples, columns, unit, tuple(files.remarks))


def _car(files: RunFiles, stated: MotionColumn, height: float) -> MotionSignal:
    """The motion of the car, or of the counterweight where that alone is measured.

    Heights outside of the shaft are told by the check of the new campaign, with what to write; here it starts at a landing.
    """
    starts = (None, 0.0, height)
    for start in starts:
        try:
            found = read_motion(files, stated, "car", height, start)
            found = found or read_motion(files, stated, "counterweight", height, start)
        except InputError:
            if start == starts[-1]:
                raise
            continue
        if found is not None:
            return found
    raise InputError(f"{files.folder / files.spec.file}: no motion of the car")


def _car_by_values(files: RunFiles, file: str, height: float) -> str:
    """The only column that moves one way, as far as a car in a shaft of this height [m]; `InputError` if none."""
    names = [column.name for column in files.table(file).columns if not is_time_name(column.name)]
    found = []
    for name in names:
        try:
            car = read_motion(files, MotionColumn(column=name, quantity="position"), "car", height, None)
        except InputError:
            continue
        value = car.value[np.isfinite(car.value)] if car else np.zeros(1)
        reach = float(np.ptp(value))
        if reach > SHORTEST_TRIP and abs(float(np.median(value[-FEWEST:]) - np.median(value[:FEWEST]))) > ONE_WAY * reach:
            found.append(name)
    if len(found) != 1:
        columns = printable(", ".join(found or names), 200)
        path = files.folder / file
        raise InputError(f"{path}: which column is the position of the car? Rename it car_position; it may be: {columns}")
    return found[0]


def noise(runs: Sequence[SurveyedRun], name: str) -> float | None:
    """Standard deviation of a column's samples at rest, in its own unit, median over the runs; None without rests."""
    found = []
    for run in runs:
        for own, samples in run.samples.items():
            if plain_name(own) == plain_name(name):
                rest = samples.values[(samples.time <= samples.time[0] + run.rest) & np.isfinite(samples.values)]
                if len(rest) >= FEWEST:
                    steps = np.diff(rest)
                    found.append(MAD_FACTOR * float(np.median(np.abs(steps - np.median(steps)))) / 2.0**0.5)
    return float(f"{np.median(found):.2g}") if found and np.median(found) > 0.0 else None
