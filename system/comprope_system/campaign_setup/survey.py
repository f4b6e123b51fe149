"""What raw logger files hold: the car, the columns that are channels, their noise at rest, and the travel of each run."""

from collections.abc import Collection, Sequence
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
from .run_grouping import RunGroup, words

Floats = NDArray[np.float64]

SAYS_NOTHING = frozenset(
    [
        "value", "values", "wert", "messwert", "data", "signal", "y", "reading", "channel", "kanal", "ch", "ai", "in", "input",
        "column", "measurement",
    ]
)  # fmt: skip
FEWEST = 20  # samples at the beginning and the end of a column that tell how far it moved
SHORTEST_TRIP = 1.0  # m that a column must reach to be taken for the car's position by its values
ONE_WAY = 0.9  # share of its reach between the first and the last position of such a column


@dataclass(frozen=True)
class SurveyedColumn:
    """A further column of numbers: its samples, the file that has it, and whether its clock is related to that of the car."""

    raw: RawColumn
    samples: Samples
    file: str
    related: bool = True


@dataclass(frozen=True)
class SurveyedRun:
    """The files of a run: the motion of the car, its trip, each further column of numbers, and the assumed unit of time.

    A column of another file than the car's is named by that file as well, where its own name says nothing.
    """

    group: RunGroup
    car: MotionSignal
    trip: Trip | None
    columns: dict[str, SurveyedColumn]
    time_unit: str | None

    @property
    def file(self) -> str:
        """The file with the car's motion, which names the run."""
        return self.group.file

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


def survey(folder: Path, groups: Sequence[RunGroup], model: RopeModel, car: MotionColumn) -> list[SurveyedRun]:
    """The content of the runs' files in `folder`; raises `InputError` with one line for each run without a motion of a car."""
    found, problems = [], []
    for group in groups:
        try:
            found.append(_run(folder, group, model, car))
        except InputError as error:
            problems += str(error).splitlines()
    if problems:
        raise InputError("\n".join(problems))
    return found


def _run(folder: Path, group: RunGroup, model: RopeModel, stated: MotionColumn) -> SurveyedRun:
    files = RunFiles(folder, RunSpec(file=group.file), FileFormat(), folder)
    table = files.table(group.file)
    if not car_column(table) and not car_column(table, COUNTERWEIGHT_NAMES):
        stated = MotionColumn(column=_car_by_values(files, group.file, model.shaft.height))
    car = _car(files, stated, model.shaft.height)
    columns = {name: one for name, one in _columns(files, group.file).items() if name != car.column}
    for other in group.others:
        columns |= _columns(files, other, taken=columns)
    try:
        trip = recover_trip(car.time, car.value) if car.quantity == "position" else None
    except InputError:
        trip = None
    unit = files.assumed_unit if files.assumed_unit != "s" else None
    return SurveyedRun(group, car, trip, columns, unit)


def _columns(files: RunFiles, file: str, taken: Collection[str] = ()) -> dict[str, SurveyedColumn]:
    """The columns of numbers of one file by names that are not `taken`."""
    unrelated = RunFiles(files.folder, RunSpec(file=file), FileFormat(), files.within)
    raw = [one for one in files.table(file).columns if not is_time_name(one.name)]
    found: dict[str, SurveyedColumn] = {}
    for column in raw:
        for read, related in ((files, True), (unrelated, False)):
            try:
                samples = read.samples(column, file, Reading(), CHANNEL_RULES)
            except InputError:
                continue  # a column of texts, or times that are on no clock of the run
            found[column.name] = SurveyedColumn(column, samples, file, related)
            break
    if file == files.spec.file:
        return found
    return dict(zip(_names(list(found), file, files.spec.file, taken), found.values(), strict=True))


def _names(names: Sequence[str], file: str, main: str, taken: Collection[str]) -> list[str]:
    """Names of the columns of another file than the run's: with what its name adds, where their own say nothing or are taken."""
    adds = " ".join(one for one in words(file) if one not in words(main)) or Path(file).stem
    plain, found = {plain_name(one) for one in taken}, []
    for name in names:
        shown = f"{adds} {name}" if plain_name(name) in plain or _says_nothing(name) else name
        found.append(shown if plain_name(shown) not in plain else f"{Path(file).stem} {name}")
    return found


def _says_nothing(name: str) -> bool:
    return plain_name(name).rstrip("0123456789").strip("_") in SAYS_NOTHING


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
