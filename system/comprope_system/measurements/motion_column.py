"""The measured motion of the car, or of the counterweight, in SI units."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from comprope.errors import InputError

from .campaign_file import MotionColumn
from .columns.car_units import SHORTEST, SPEEDS, fastest, fits_shaft, length_unit, middle_speed, time_unit
from .columns.column_names import COUNTERWEIGHT_NAMES, car_column, find_column
from .columns.readings import written_unit
from .columns.signal_faults import MOTION_RULES
from .files.raw_table import RawColumn, RawTable, printable
from .motion.position_signal import resolution
from .run_files import RunFiles, Samples
from .units import MOTIONS, TIMES, unit_named

Floats = NDArray[np.float64]

FEWEST = 20  # samples from which a motion can be estimated
COARSE = 5e-3  # m; steps of a position from which on they are worth a remark
START = 0.25  # s at the beginning of a record over which the position at the start is taken
DEFAULT_UNITS = {"position": "m", "speed": "m/s", "acceleration": "m/s2"}
SLOWEST_SAMPLING = 1.0  # s between samples of a record whose unit of time is to be believed without the car's motion


@dataclass(frozen=True)
class MotionSignal:
    """A measured motion: `value` (n,) [m, m/s or m/s2] at `time` (n,) [s], NaN where there is none; its column, and remarks."""

    time: Floats
    value: Floats
    quantity: str
    column: str
    remarks: tuple[str, ...] = ()


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
    """What a column of the car's motion holds, by its unit; position if that says nothing."""
    written = written_unit(column)
    unit = unit_named(written) if written else None
    return next((quantity for quantity, units in MOTIONS.items() if unit in units), "position")


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
        _require_in_shaft(value, column.name, height, key, start)
    time = samples.time if samples.sure else _checked_time(files, samples, value, quantity, height)
    if quantity == "position":
        remarks = [*remarks, *_implausible(time, value, column.name, samples.sure)]
    return MotionSignal(time, value, quantity, column.name, (*samples.remarks, *remarks))


def _implausible(time: Floats, value: Floats, name: str, sure: bool) -> Iterator[str]:
    """Sentences about a motion whose size, resolution or, where the unit of time is stated, speed is hardly a car's."""
    low, high = np.nanpercentile(value, (1.0, 99.0))
    if high - low < SHORTEST:
        yield f"{name}: moves by {1e3 * (high - low):.3g} mm in all: check its unit"
    elif sure and (found := middle_speed(time, value)) is not None and not SPEEDS[0] <= found[0] <= fastest(found[1]):
        usual = f"{SPEEDS[0]:g} to {fastest(found[1]):.3g} m/s is usual over {found[1]:.3g} m"
        yield f"{name}: moves at {found[0]:.3g} m/s; {usual}: check the units of time and position"
    if (step := resolution(value[np.isfinite(value)])) >= COARSE:
        yield f"{name}: changes in steps of {1e3 * step:.2g} mm, by which the motion may be uncertain"


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


def _checked_time(files: RunFiles, samples: Samples, value: Floats, quantity: str, height: float) -> Floats:
    """The times in the unit with which the motion is a car's, where no file states that unit."""
    found = middle_speed(samples.time, value) if quantity == "position" else _speed_of(samples, value, quantity, height)
    step = float(np.median(np.diff(samples.time)))
    if found is None:
        if step >= SLOWEST_SAMPLING:
            raise InputError(f"time: samples are {step:g} s apart: in which unit is it? Write time_unit under [file]")
        return samples.time
    speed, travel = found
    if SPEEDS[0] <= speed <= fastest(travel):
        return samples.time
    unit = time_unit(speed, travel)
    if unit is not None:
        files.assume_time_unit(unit, f"in seconds the car would move at {speed:.3g} m/s")
        return samples.time * TIMES[unit]
    if speed < SPEEDS[0] and step < SLOWEST_SAMPLING:
        return samples.time
    raise InputError(
        f"the car would move at {speed:.3g} m/s; {SPEEDS[0]:g} to {fastest(travel):.3g} m/s is accepted over {travel:.3g} m: "
        "check the unit of the car, and "
        "write time_unit under [file], or, if time counts samples, their rate"
    )


def _speed_of(samples: Samples, value: Floats, quantity: str, height: float) -> tuple[float, float] | None:
    """Speed and travel for `time_unit` from a measured speed, whose travel is too long by as much as the unit of time."""
    if quantity != "speed":
        return None
    known = np.isfinite(value)
    travel = float(trapezoid(np.abs(value[known]), samples.time[known]))
    top = float(np.percentile(np.abs(value[known]), 99.0))
    return (top, travel) if travel <= height + 1.0 else (top * height / travel, height)


def _require_in_shaft(value: Floats, name: str, height: float, key: str, start: float | None) -> None:
    if fits_shaft(value, height):
        return
    low, high = np.nanpercentile(value, (1.0, 99.0))
    reach = f"{name} lies from {low:.5g} to {high:.5g} m, outside of the shaft (0 to {height:g} m)"
    if start is None and high - low <= height + 1.0:
        first = float(np.nanmedian(value[: max(len(value) // 100, 1)]))
        advice = (
            f"write zero = ... (its reading at the bottom landing) and sign = -1 if it counts downward under [{key}], "
            f"or, if it counts from {first:.3g} m at the start of each run, car_start = ... in the run"
        )
    else:
        advice = f"check unit, scale, sign and zero under [{key}], and shaft.height of the model"
    raise InputError(f"{reach}: {advice}")
