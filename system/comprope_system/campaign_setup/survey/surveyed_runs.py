"""What raw logger files hold: the car, the columns that are channels, their noise at rest, and the travel of each run."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError
from comprope.rope.effects import RopeModel

from ...measurements.campaign_file import MotionColumn, Reading, RunSpec
from ...measurements.columns.column_names import is_time_name, plain_name
from ...measurements.columns.signal_faults import CHANNEL_RULES
from ...measurements.files.file_format import FileFormat
from ...measurements.files.raw_table import RawColumn
from ...measurements.motion.recover import recover_trip
from ...measurements.motion.trip import Trip
from ...measurements.runs.motion_column import MotionSignal
from ...measurements.runs.run_files import RunFiles, Samples
from ..column_roles import says_nothing
from .run_grouping import RunGroup, words
from .surveyed_motion import SurveyedMotion, survey_motion
from .unread_columns import unread_columns

Floats = NDArray[np.float64]


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

    A column of another file than the car's is named by that file as well, where its own name says nothing. `unread` are sentences
    about columns of cells that look like numbers and are none.
    """

    group: RunGroup
    motion: SurveyedMotion
    trip: Trip | None
    columns: dict[str, SurveyedColumn]
    time_unit: str | None
    unread: tuple[str, ...] = ()

    @property
    def file(self) -> str:
        """The file with the car's motion, which names the run."""
        return self.group.file

    @property
    def car(self) -> MotionSignal:
        """The motion of the car."""
        return self.motion.car

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
    """The content of the runs' files in `folder`, with the column of the `car` if that is stated.

    Raises `InputError` with one line for each run without a motion of a car.
    """
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
    motion = survey_motion(files, model.shaft.height, stated)
    car = motion.car
    columns = {name: one for name, one in _columns(files, group.file).items() if name not in motion.columns}
    for other in group.others:
        columns |= _columns(files, other, taken=columns)
    try:
        trip = recover_trip(car.time, car.value) if car.quantity == "position" else None
    except InputError:
        trip = None
    unit = files.assumed_unit if files.assumed_unit != "s" else None
    read = {one.raw.name for one in columns.values()} | motion.columns
    unread = [sentence for file in (group.file, *group.others) for sentence in unread_columns(files.table(file), file, read)]
    return SurveyedRun(group, motion, trip, columns, unit, tuple(unread))


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
        shown = f"{adds} {name}" if plain_name(name) in plain or says_nothing(name) else name
        found.append(shown if plain_name(shown) not in plain else f"{Path(file).stem} {name}")
    return found
