"""Which column of a raw file is the motion of the car, or of the counterweight where that alone is measured."""

from dataclasses import dataclass

import numpy as np

from comprope.errors import InputError

from ...measurements.campaign_file import MotionColumn
from ...measurements.columns.column_names import COUNTERWEIGHT_NAMES, car_column, is_time_name
from ...measurements.files.raw_table import printable
from ...measurements.runs.motion_column import MotionSignal, mirrored, read_motion
from ...measurements.runs.run_files import RunFiles

FEWEST = 20  # samples at the beginning and the end of a column that tell how far it moved
SHORTEST_TRIP = 1.0  # m that a column must reach to be taken for the car's position by its values
ONE_WAY = 0.9  # share of its reach between the first and the last position of such a column


@dataclass(frozen=True)
class SurveyedMotion:
    """The motion of the car, from the column of the `end` "car" or "counterweight", and all columns that hold such motions.

    `told`: its column is stated, or found by its values; `grounded`: its heights are above the bottom landing, not the start.
    """

    car: MotionSignal
    end: str
    columns: frozenset[str]
    told: bool
    grounded: bool

    @property
    def column(self) -> str:
        """The column's name."""
        return self.car.column


def survey_motion(files: RunFiles, height: float, stated: MotionColumn) -> SurveyedMotion:
    """The motion in the run's file, in a shaft of this height [m], from the column that is `stated`, or else from its names.

    Raises `InputError` if there is none, or several may be.
    Heights outside of the shaft are told by the check of the new campaign, with what to write; here it starts at a landing.
    """
    table = files.table(files.spec.file)
    car_named, counterweight_named = car_column(table), car_column(table, COUNTERWEIGHT_NAMES)
    named = [one for one in (car_named, counterweight_named) if one is not None]
    if stated.column is None or (car_named is None and counterweight_named and counterweight_named[0].name == stated.column):
        stated = MotionColumn() if named else MotionColumn(column=_by_values(files, height))
    first: InputError | None = None  # what the positions as they are lack; a guessed start has problems of its own
    for start in (None, 0.0, height):
        try:
            car = read_motion(files, stated, "car", height, start)
            counterweight = read_motion(files, stated, "counterweight", height, start) if car is None else None
        except InputError as error:
            first = first or error
            continue
        found = car or (mirrored(counterweight, height) if counterweight else None)
        if found is not None:
            columns = frozenset((found.column, *(column.name for column, _ in named)))
            grounded = start is None and found.quantity == "position"
            return SurveyedMotion(found, "car" if car else "counterweight", columns, stated.column is not None, grounded)
    raise first or InputError(f"{files.folder / files.spec.file}: no motion of the car")


def _by_values(files: RunFiles, height: float) -> str:
    """The only column that moves one way, as far as a car in a shaft of this height [m]; `InputError` if none."""
    names = [column.name for column in files.table(files.spec.file).columns if not is_time_name(column.name)]
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
        path = files.folder / files.spec.file
        raise InputError(f"{path}: which column is the position of the car? Rename it car_position; it may be: {columns}")
    return found[0]
