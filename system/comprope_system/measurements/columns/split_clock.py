"""Clocks of controllers in two columns: whole seconds as date or time of day, and milliseconds beside them."""

from dataclasses import replace

import pandas as pd

from ..files.cells.numerals import to_numbers
from ..files.cells.time_stamps import is_time_stamp
from ..files.raw_table import RawColumn, RawTable
from .column_names import is_time_name, plain_name

MILLISECONDS = frozenset(
    [
        "ms", "msec", "msecs", "millisec", "millisecs", "millisecond", "milliseconds", "milli", "millitm", "millisekunde",
        "millisekunden",
    ]
)  # fmt: skip
WITHIN = 1000.0


def with_joined_clock(table: RawTable) -> RawTable:
    """The table with one column of times in place of one of whole seconds and one of milliseconds, with a remark."""
    parts = [one for one in table.columns if plain_name(one.name) in MILLISECONDS and _are_parts(one, table.decimal)]
    wholes = [one for one in table.columns if is_time_name(one.name) and _are_whole(one)]
    if len(parts) != 1 or len(wholes) != 1 or parts[0] is wholes[0]:
        return table
    whole, part = wholes[0], parts[0]
    milliseconds, _, _ = to_numbers(part.values.astype(str), table.decimal, ())
    texts = [
        f"{text}.{round(number):03d}" if text and number == number else ""
        for text, number in zip(whole.values.fillna("").astype(str).str.strip(), milliseconds, strict=True)
    ]
    joined = replace(whole, values=pd.Series(texts))
    columns = tuple(joined if one is whole else one for one in table.columns if one is not part)
    return replace(table, columns=columns, remarks=(*table.remarks, f"{whole.name} is read with the milliseconds of {part.name}"))


def _are_parts(column: RawColumn, decimal: str) -> bool:
    """Whether all numbers of a column are parts of a second in milliseconds, which begin anew."""
    numbers, wrong, _ = to_numbers(column.values.astype(str), decimal, ())
    known = numbers.dropna()
    inside = len(known) > 1 and bool((known >= 0.0).all() and (known < WITHIN).all())
    return inside and not wrong and bool((known.diff() < 0.0).any())


def _are_whole(column: RawColumn) -> bool:
    """Whether a column holds dates or times of day to the second."""
    texts = [one for one in column.values.head(200) if isinstance(one, str) and one.strip()]
    return bool(texts) and all(is_time_stamp(one) and "." not in one.rpartition(":")[2] and "," not in one for one in texts)
