"""The measured motion of the car, or of the counterweight, in SI units."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError

from ..campaign_file import MotionColumn
from ..columns.car_units import length_unit
from ..columns.column_names import COUNTERWEIGHT_NAMES, car_column, find_column, quantity_named
from ..columns.readings import written_unit
from ..columns.signal_faults import MOTION_RULES
from ..files.raw_table import RawColumn, RawTable, printable
from ..units import MOTIONS, unit_named
from .motion_plausibility import checked_time, implausible, require_in_shaft
from .run_files import RunFiles

Floats = NDArray[np.float64]

FEWEST = 20  # samples from which a motion can be estimated
START = 0.25  # s at the beginning of a record over which the position at the start is taken
DEFAULT_UNITS = {"position": "m", "speed": "m/s", "acceleration": "m/s2"}


@dataclass(frozen=True)
class MotionSignal:
    """A measured motion: `value` (n,) [m, m/s or m/s2] at `time` (n,) [s], NaN where there is none.

    Its column in the file, remarks, and the unit in which the column was read.
    """

    time: Floats
    value: Floats
    quantity: str
    column: str
    remarks: tuple[str, ...] = ()
    unit: str = "m"


def mirrored(signal: MotionSignal, height: float) -> MotionSignal:
    """The motion of the car that mirrors the counterweight's in a shaft of this height [m], or the reverse."""
    level = height if signal.quantity == "position" else 0.0
    return replace(signal, value=level - signal.value)


def read_motion(files: RunFiles, stated: MotionColumn, key: str, height: float, start: float | None) -> MotionSignal | None:
    """The motion of "car" or "counterweight" in a shaft of this height [m]; None if there is none, but a column of the other one.

    `start` [m] is the position at the beginning where the column counts from there. Raises `InputError`, which names the file, if
    the position does not lie in the shaft, or the speed is no car's in whatever unit.
    """
    file = files.file_of(key)
    try:
        table = files.table(file)
        found = _column(files, table, stated, key)
        if found is None:
            return None
        column, quantity = found
        return _signal(files, file, column, quantity, stated, key, height, start)
    except InputError as error:
        raise files.named(file, error) from None


def _column(files: RunFiles, table: RawTable, stated: MotionColumn, key: str) -> tuple[RawColumn, str] | None:
    name = files.spec.columns.get(key, stated.column)
    if name is not None:
        column = find_column(table, name)
        return column, stated.quantity or _quantity(column)
    if key == "counterweight":
        return car_column(table, COUNTERWEIGHT_NAMES)
    found = car_column(table)
    if found is None:
        if files.spec.columns.get("counterweight") or car_column(table, COUNTERWEIGHT_NAMES):
            return None
        names = printable(", ".join(one.name for one in table.columns), 300)
        raise InputError(f'no column car_position; the header has {names}: write column = "..." under [car]')
    return found[0], stated.quantity or found[1]


def _quantity(column: RawColumn) -> str:
    """What a column of a motion holds, by its unit, or else by its name; position if neither says anything."""
    written = written_unit(column)
    unit = unit_named(written) if written else None
    return next((quantity for quantity, units in MOTIONS.items() if unit in units), quantity_named(column.name))


def _signal(
    files: RunFiles, file: str, column: RawColumn, quantity: str, stated: MotionColumn, key: str,
    height: float, start: float | None,
) -> MotionSignal:  # fmt: skip
    units = MOTIONS[quantity]
    samples = files.samples(column, file, stated, MOTION_RULES)
    if (count := int(np.isfinite(samples.values).sum())) < FEWEST:
        raise InputError(f"{quantity}: {count} numbers; at least {FEWEST} are needed to estimate the motion of the {key}")
    readings = stated.sign * stated.factor * (samples.values - stated.zero)
    unit, remarks = _unit(files, column, readings, quantity, stated, key, height)
    value = samples.values if (unit, stated.sign, stated.factor, stated.zero) == ("m", 1, 1.0, 0.0) else readings * units[unit]
    if start is not None and quantity == "position":
        first = samples.time <= samples.time[0] + START
        value = value - np.nanmedian(value[first]) + start
    if quantity == "position":
        require_in_shaft(value, column.name, height, key, start)
    time = samples.time if samples.sure else checked_time(files, samples, value, quantity, height)
    if quantity == "position":
        remarks = [*remarks, *implausible(time, value, column.name, samples.sure)]
    return MotionSignal(time, value, quantity, column.name, (*samples.remarks, *remarks), unit)


def _unit(
    files: RunFiles, column: RawColumn, readings: Floats, quantity: str, stated: MotionColumn, key: str, height: float
) -> tuple[str, list[str]]:
    """The unit of the motion, as stated, as written in the file, or by the shaft; and a remark where it was not stated."""
    units = MOTIONS[quantity]
    if stated.unit is not None:
        if stated.unit not in units:
            raise InputError(f'{key}.unit = "{printable(stated.unit)}": for {quantity} {", ".join(units)} are accepted')
        if problem := files.unit_problem(column, stated.unit, units, stated.factor, f"[{key}]"):
            raise InputError(problem)
        return stated.unit, []
    written = written_unit(column)
    known = unit_named(written) if written and not files.stated.ignore_units else None
    if known in units:
        return known, []
    if known is not None or (written and not files.stated.ignore_units and column.unit):
        accepted = ", ".join(units)
        raise InputError(
            f"{column.name}: the file states the unit {printable(written)}; for {quantity} {accepted} are accepted: "
            f"write unit and scale under [{key}]"
        )
    guess = length_unit(readings, height, units) if quantity == "position" else None
    if guess is None:
        return DEFAULT_UNITS[quantity], []
    reach = f"{np.nanmin(readings):.6g} to {np.nanmax(readings):.6g} m in a shaft of {height:g} m"
    return guess, [
        f'{column.name} read in {guess}: in metres it would reach from {reach}; write unit = "{guess}" under [{key}] to confirm'
    ]
