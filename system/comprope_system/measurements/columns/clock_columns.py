"""Which columns of a table are clocks, and which of them is that of a column."""

from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime, time

import numpy as np
import pandas as pd

from ..files.cells.time_stamps import is_time_stamp
from ..files.raw_table import RawColumn, RawTable
from .column_names import find_column, is_time_name, named_one_of, plain_name

LOOKED_AT = 200  # samples that tell whether a column counts time
RARELY = 0.05  # share of steps that go back, or on, up to which a column is a clock, or none
EVEN = 0.1  # of the mean step: standard deviation of the steps of an even clock
FEWEST = 5  # numbers that tell
FEWEST_PAIRS = 2  # of a clock and a signal each
SAMPLE_NUMBERS = frozenset(
    [
        "sample",
        "samples",
        "index",
        "idx",
        "no",
        "nr",
        "n",
        "#",
        "scan",
        "sample_no",
        "sample_nr",
        "sample_number",
        "samplenumber",
        "point",
        "record",
    ]
)


def clock_columns(table: RawTable, stated: str | None) -> list[RawColumn]:
    """The columns of times: the stated one, else those named so, else one of sample numbers, else none."""
    if stated:
        return [find_column(table, stated)]
    table = replace(table, columns=tuple(one for one in table.columns if _distinct(one) > 0))
    named = [one for one in table.columns if is_time_name(one.name)]
    named = named or [one for one in table.columns if any(map(is_time_name, one.aliases))]
    counting = [one for one in named if _counts(one)]  # "response_time" and "cycle_time" are no clocks
    found = counting or named or named_one_of(table, sorted(SAMPLE_NUMBERS))[:1]
    return found or [one for one in table.columns if _is_stamped(one)][:1] or clocks_beside(table)


def unnamed_clocks(table: RawTable) -> list[RawColumn]:
    """Columns beyond the first that count evenly, as a clock does, but are not named as times or sample numbers, nor used so."""
    used = [one.name for one in clock_columns(table, None)]
    return [
        one
        for one in table.columns[1:]
        if one.clock is None
        and one.name not in used
        and plain_name(one.name) not in SAMPLE_NUMBERS
        and not is_time_name(one.name)
        and _is_even(one)
    ]


def clocks_beside(table: RawTable) -> list[RawColumn]:
    """Clocks that stand before each column, whatever their names: every other column from the first on, all alike at first."""
    clocks, others = table.columns[::2], table.columns[1::2]
    if len(clocks) != len(others) or len(clocks) < FEWEST_PAIRS or not all(map(_is_even, clocks)):
        return []
    begins = [_first_numbers(one) for one in clocks]
    alike = all(len(one) == len(begins[0]) and np.allclose(one, begins[0], rtol=0.0, atol=EVEN) for one in begins)
    return list(clocks) if alike and not all(map(_is_even, others)) else []


def _first_numbers(column: RawColumn) -> np.ndarray:
    """The first numbers of a column, in steps of the first of them."""
    some = column.values.head(LOOKED_AT).astype(str).str.replace(",", ".", regex=False)
    numbers = pd.to_numeric(some, errors="coerce").dropna().to_numpy()[:FEWEST]
    return np.asarray(numbers / (numbers[1] - numbers[0])) if len(numbers) > 1 and numbers[1] != numbers[0] else numbers


def _is_even(column: RawColumn) -> bool:
    """Whether the first numbers of a column increase by nearly equal steps."""
    some = column.values.head(LOOKED_AT).astype(str).str.replace(",", ".", regex=False)
    steps = np.diff(pd.to_numeric(some, errors="coerce").dropna().to_numpy())
    return len(steps) > FEWEST and bool(steps.min() > 0.0 and np.std(steps) < EVEN * np.mean(steps))


def _counts(column: RawColumn) -> bool:
    """Whether a column increases nearly everywhere, as far as it holds numbers: a clock may be set back once, or repeat times."""
    some = column.values.iloc[:: max(len(column.values) // LOOKED_AT, 1)]
    numbers = pd.to_numeric(some.astype(str).str.replace(",", "."), errors="coerce").dropna().to_numpy()
    if len(numbers) < FEWEST:
        return _distinct(column) > 1
    steps = np.diff(numbers)
    return bool(np.mean(steps < 0.0) < RARELY and np.mean(steps > 0.0) > RARELY)


def _is_stamped(column: RawColumn) -> bool:
    """Whether a column holds dates or times of day, by its type or its first cell."""
    if pd.api.types.is_datetime64_any_dtype(column.values):
        return True
    first = next((one for one in column.values.head(LOOKED_AT) if not pd.isna(one) and one != ""), None)
    return isinstance(first, datetime | time) or (isinstance(first, str) and is_time_stamp(first))


def _distinct(column: RawColumn) -> int:
    """Number of different values that are not empty, among some of the whole column."""
    some = column.values.iloc[:: max(len(column.values) // LOOKED_AT, 1)]
    return int(some[some.notna() & (some.astype(str) != "")].nunique())


def clock_of(column: RawColumn, clocks: Sequence[RawColumn], table: RawTable) -> RawColumn:
    """The clock of a column: of those in its group of the file, or in one around it, the nearest on its left."""
    shared = [_shared(column.group, one.group) for one in clocks]
    nearest = [one for one, depth in zip(clocks, shared, strict=True) if depth == max(shared)]
    names = [one.name for one in table.columns]
    before = [one for one in nearest if names.index(one.name) < names.index(column.name)]
    return before[-1] if before else nearest[0]


def _shared(group: str, other: str) -> int:
    """Number of groups that contain both; -1 for a clock in a group that does not contain the column."""
    own, around = ([part for part in path.split("/") if part] for path in (group, other))
    return len(around) if own[: len(around)] == around else -1
