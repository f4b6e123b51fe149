"""Times written as numbers: seconds, milliseconds, sample numbers, epochs, days, digits of the time of day."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comprope.errors import InputError

from ..files.cells.numerals import to_numbers
from ..files.file_format import FileFormat
from ..files.raw_table import RawColumn, RawTable, printable
from ..units import TIMES, split_unit, unit_named
from .times import TimeAxis

SAMPLE_NAMES = re.compile(
    r"(sample|samples|index|idx|no|nr|n|#|scan|count|counter|row|record|point|punkt|zeile)\.?( ?(no|nr|number|#)\.?)?",
    re.IGNORECASE,
)
EPOCH = (1e9, 5e9)  # s since 1970 of the years 2001 to 2128; LabVIEW's seconds since 1904 lie there too
DAY_NUMBERS = ((2e4, 8e4), (7e5, 8e5), (2.4e6, 2.5e6))  # days of Excel and OLE, of MATLAB and Python, Julian
TICK = 1e-7  # s, of the clocks of Windows and .NET
TICKS = {  # by clock: the first and last number of ticks from 1980 to 2200, and those of 1970
    "Windows": (1.196e17, 1.890e17, 116_444_736_000_000_000),
    ".NET": (6.245e17, 6.939e17, 621_355_968_000_000_000),
}
SHORTEST = 0.5  # a record of a trip is longer [s]; times that span less are days or hours
COUNTED = 20  # times that increase by 1 and are rather sample numbers than seconds
MOSTLY = 0.5  # share of the steps of sample numbers that are 1; the others are samples that were lost
FRACTION = 0.1  # a record shorter than this share of its first time, between 0 and 1, is a part of a day
EPOCH_DIGITS = 6  # of a second that a double holds of an epoch or a day number


def numeric_times(column: RawColumn, table: RawTable, stated: FileFormat) -> TimeAxis:
    """The times of a column of numbers, in the unit stated, written in the file, or shown by their size."""
    numbers = _numbers(column, table, stated)
    known = numbers[np.isfinite(numbers.astype(float))]
    if not len(known):
        raise InputError(f"{column.name}: no times in this column")
    if stated.time_unit is not None:
        return _in_stated_unit(numbers, known, stated.time_unit, stated.rate or table.rate)
    written = column.unit or split_unit(column.name)[1]
    unit = unit_named(written) if written else None
    base = split_unit(column.name)[0].strip()
    counts = _counts_samples(known)
    rated = unit is None and (stated.rate or table.rate or 1.0) != 1.0
    if counts and unit is None and not rated and len(known) >= COUNTED and not SAMPLE_NAMES.fullmatch(base):
        raise InputError(
            f'{column.name} counts 1 by 1: seconds or sample numbers? Write time_unit = "s", or rate = ... [Hz], under [file]'
        )
    if unit == "sample" or (counts and (SAMPLE_NAMES.fullmatch(base) or rated)):
        return _in_stated_unit(numbers, known, "sample", stated.rate or table.rate)
    if unit in TIMES:
        return _scaled(numbers, known, unit)
    if unit is None and (seconds := _of_day(numbers, known)) is not None:
        return _scaled(seconds, seconds[np.isfinite(seconds)], "s", "clock", "time read as digits of the time of day, HHMMSS")
    if unit is None and (ticks := _ticks(numbers, known)) is not None:
        return ticks
    if (by_size := _by_size(known)) is not None:
        return _scaled(numbers, known, *by_size)
    return replace(_scaled(numbers, known, "s"), sure=False)


def _numbers(column: RawColumn, table: RawTable, stated: FileFormat) -> NDArray:
    """Numbers (n,) of a column of times; whole ones stay whole: nanoseconds since 1970 need more digits than a double has."""
    if column.is_numeric:
        return column.values.to_numpy()
    whole = pd.to_numeric(column.values, errors="coerce") if table.decimal == "." else None
    if whole is not None and whole.dtype.kind in "iu":
        return whole.to_numpy()
    found, wrong, _ = to_numbers(column.values, table.decimal, stated.missing)
    if wrong:
        cell = printable(repr(column.values.iloc[wrong[0]]))
        raise InputError(f"{column.name} = {cell} in {table.row_text(wrong[0])}: a number, a time or a date is accepted")
    return found.to_numpy()


def _in_stated_unit(numbers: NDArray, known: NDArray, unit: str, rate: float | None) -> TimeAxis:
    if unit == "sample":
        if rate is None:
            raise InputError("time counts samples: write their rate [Hz] under [file], e.g. rate = 1000.0")
        return TimeAxis(
            (numbers - known[0]) / rate, float(known[0]) / rate, "relative", remark=f"time counts samples, {rate:g} per second"
        )
    named = unit_named(unit)
    if named not in TIMES:
        raise InputError(f'file.time_unit = "{printable(unit)}": {", ".join(TIMES)} or sample is accepted')
    return _scaled(numbers, known, named)


def _scaled(numbers: NDArray, known: NDArray, unit: str, kind: str = "relative", remark: str | None = None) -> TimeAxis:
    shifted = (numbers - known[0]) if known[0] != 0 else numbers
    seconds = np.asarray(shifted, float) * TIMES[unit] if unit != "s" else np.asarray(shifted, float)
    if kind == "date" and numbers.dtype.kind == "f":
        seconds = np.round(seconds, EPOCH_DIGITS)
    return TimeAxis(seconds, float(known[0]) * TIMES[unit], kind, unit, remark=remark)


def _ticks(numbers: NDArray, known: NDArray) -> TimeAxis | None:
    """Times of a clock that counts ticks of 100 ns since 1601 or the year 1; None for all others."""
    for clock, (low, high, zero) in TICKS.items():
        if low < float(known[0]) < high:
            seconds = np.asarray(numbers - known[0], float) * TICK
            origin = float(known[0] - zero) * TICK
            return TimeAxis(seconds, origin, "date", remark=f"time read as ticks of 100 ns of the clock of {clock}")
    return None


def _by_size(known: NDArray) -> tuple[str, str, str] | None:
    """Unit, kind and remark of times that are an epoch or day numbers, by their size; None for all others."""
    first, span = float(known[0]), float(known[-1] - known[0])
    for unit in ("s", "ms", "us", "ns"):
        if EPOCH[0] < first * TIMES[unit] < EPOCH[1]:
            return unit, "date", f"time read as {unit} since an epoch"
    if any(low < first < high for low, high in DAY_NUMBERS) and span < SHORTEST:
        return "d", "date", "time read as day numbers"
    if 0.0 < first < 1.0 and 0.0 < span < FRACTION * first:
        return "d", "clock", "time read as fractions of a day"
    return None


def _counts_samples(known: NDArray) -> bool:
    """Whether numbers (n,) increase by one, but for samples that were lost."""
    steps = np.diff(known)
    return len(known) > 2 and bool(np.all((steps >= 1) & (steps == np.round(steps))) and np.mean(steps == 1) > MOSTLY)


def _of_day(numbers: NDArray, known: NDArray) -> NDArray | None:
    """Seconds of times of day written as numbers, 91201.123 for 09:12:01.123; None for others.

    They show by their steps of more than 40 from one minute to the next, and by digits that are no more than 59.
    """

    def seconds(values: NDArray) -> NDArray:
        hours, rest = np.divmod(values, 10000.0)
        return np.asarray(3600.0 * hours + 60.0 * (rest // 100.0) + rest % 100.0)

    digits = bool(np.all((known >= 0) & (known < 240000) & (known % 100 < 60) & (known % 10000 < 6000)))
    if not digits or len(known) < 2:
        return None
    jump = float(np.max(np.diff(known)))
    return seconds(numbers) if jump > 40.0 and float(np.max(np.diff(seconds(known)))) < jump - 39.0 else None
