"""Rows that are repeated, or stand with the newest first."""

from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comprope.errors import InputError

from ..files.file_format import FileFormat
from ..files.raw_table import RawColumn, RawTable
from .clock_columns import clock_columns
from .time_axis import times_of

LOOKED_AT = 60  # rows, evenly spaced, that tell whether the newest stands first


def in_order(table: RawTable, stated: FileFormat) -> RawTable:
    """The table with its rows from the oldest to the newest, each once, and with remarks.

    A row is a repetition only if all its cells are those of the row before, its time included.
    """
    count = {len(one.values) for one in table.columns}
    clocks = [] if stated.time == "" or len(count) != 1 else clock_columns(table, stated.time)
    if not clocks or min(count) < 2:
        return table
    if _repeats(clocks[0].values).any():
        table = _each_time_once(table, clocks[0])
    if len(clocks) == 1 and _newest_first(table, stated):
        table = _selected(table, np.arange(len(table.columns[0].values))[::-1], "the newest row stands first; read from the last")
    return table


def _each_time_once(table: RawTable, clock: RawColumn) -> RawTable:
    """The table without rows that repeat the one before, and with rows of one time joined where each fills cells of its own."""
    again = np.logical_and.reduce([_repeats(one.values) for one in table.columns])
    if again.any():
        shown = "1 row repeats" if again.sum() == 1 else f"{again.sum()} rows repeat"
        return _selected(table, np.flatnonzero(~again), f"{shown} the row before, time included, and left out")
    same = _repeats(clock.values)
    place = pd.Series(np.cumsum(~same))
    filled = {one.name: one.values.replace("", np.nan).groupby(place) for one in table.columns if one is not clock}
    if any(int(groups.count().max()) > 1 for groups in filled.values()):
        return table
    joined = _selected(
        table, np.flatnonzero(~same), f"{int(same.sum())} rows fill cells of the row before, at its time, and are joined"
    )
    columns = tuple(
        replace(one, values=filled[one.name].first().reset_index(drop=True).fillna("" if one.values.dtype == object else np.nan))
        if one.name in filled
        else one
        for one in joined.columns
    )
    return replace(joined, columns=columns)


def _repeats(values: pd.Series) -> NDArray[np.bool_]:
    """Which cells (n,) are equal to the one before, or empty as that."""
    before = values.shift()
    same = (values == before) | (values.isna() & before.isna())
    found = same.fillna(False).to_numpy(dtype=bool, copy=True)
    found[0] = False
    return found


def _newest_first(table: RawTable, stated: FileFormat) -> bool:
    clock = clock_columns(table, stated.time)[0]
    rows = np.unique(np.linspace(0, len(clock.values) - 1, LOOKED_AT).astype(int))
    try:
        seconds = times_of(replace(clock, values=clock.values.iloc[rows].reset_index(drop=True)), table, stated).seconds
    except InputError:
        return False
    known = seconds[np.isfinite(seconds)]
    return bool(len(known) > 1 and np.all(np.diff(known) < 0.0))


def _selected(table: RawTable, rows: NDArray[np.int_], remark: str) -> RawTable:
    """Some rows of a table, in their order, with a remark."""
    columns = tuple(replace(one, values=one.values.iloc[rows].reset_index(drop=True)) for one in table.columns)
    numbers = None if table.rows is None else table.rows[rows]
    return replace(table, columns=columns, rows=numbers, remarks=(*table.remarks, remark))
