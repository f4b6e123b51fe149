"""Long tables, with one row for each value, made wide: a column for each name, beside its times."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from ..files.raw_table import RawColumn, RawTable, unique_names
from .clock_columns import clock_columns
from .column_names import plain_name

VALUE_NAMES = frozenset(["value", "values", "wert", "messwert", "val", "varvalue", "reading", "numericvalue", "float_value"])
NAME_NAMES = frozenset(
    [
        "name", "channel", "variable", "signal", "series", "tag", "tagname", "tag_name", "varname", "field", "sensor",
        "parameter", "quantity", "metric", "kanal", "messkanal", "signalname", "channel_name", "point", "point_name", "item",
        "measurement",
    ]
)  # fmt: skip
UNIT_NAMES = frozenset(["unit", "units", "einheit"])
MOST_NAMES = 100  # different names of signals in one file
FEWEST_ROWS = 20  # of each of two names at least


def widened(table: RawTable) -> RawTable:
    """The table with a column for each name in a long table, and with a remark; any other table as it is."""
    values = _named(table, VALUE_NAMES)
    if len(values) != 1 or len({len(one.values) for one in table.columns}) != 1:
        return table
    names = [one for one in _named(table, NAME_NAMES) if _repeats(one)]
    clocks = [one for one in clock_columns(table, None) if one is not values[0] and all(one is not other for other in names)]
    if not names or not clocks:
        return table
    # A database may repeat the name of the whole record in a second column: the one with most names tells the signals apart.
    name = max(names, key=lambda one: one.values.nunique())
    return _wide(table, name, values[0], clocks[0])


def _named(table: RawTable, known: frozenset[str]) -> list[RawColumn]:
    return [one for one in table.columns if plain_name(one.name) in known]


def _repeats(column: RawColumn) -> bool:
    """Whether a column holds a few different texts or numbers, at least two of them many times."""
    counts = column.values.value_counts()
    return len(counts) <= MOST_NAMES and int((counts >= FEWEST_ROWS).sum()) >= min(2, len(counts)) > 0


def _wide(table: RawTable, name: RawColumn, value: RawColumn, clock: RawColumn) -> RawTable:
    groups = [(_title(key, name), np.flatnonzero(name.values == key)) for key in dict.fromkeys(name.values) if not pd.isna(key)]
    units = _named(table, UNIT_NAMES)
    signals = [
        RawColumn(title, value.values.iloc[rows].reset_index(drop=True), _unit(units, rows) or value.unit)
        for title, rows in groups
    ]
    times = [clock.values.iloc[rows].reset_index(drop=True) for _, rows in groups]
    columns: list[RawColumn] = []
    for k, (signal, own) in enumerate(zip(signals, times, strict=True)):
        if k == 0 or not own.equals(times[k - 1]):
            columns.append(replace(clock, values=own))
        columns.append(signal)
    named = unique_names([one.name for one in columns])
    wide = tuple(replace(one, name=new, group="") for one, new in zip(columns, named, strict=True))
    shown = f"one row for each {value.name}: a column for each of the {len(signals)} names in {name.name}"
    return RawTable(wide, table.rate, None, table.decimal, (*table.remarks, shown))


def _title(key: object, name: RawColumn) -> str:
    """The name of a signal; of a mere number, the name of the column before it."""
    text = str(key).strip()
    return f"{name.name} {text}" if text.replace(".", "").isdigit() else text


def _unit(units: Sequence[RawColumn], rows: np.ndarray) -> str | None:
    """The unit that all rows of a signal state; None if there is none, or several."""
    found = {str(one).strip() for column in units for one in column.values.iloc[rows] if not pd.isna(one)} - {""}
    return found.pop() if len(found) == 1 else None
