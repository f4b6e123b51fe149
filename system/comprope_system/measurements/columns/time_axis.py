"""Time in seconds from zero, from whatever a logger writes: seconds, milliseconds, sample numbers, dates, times of day, days."""

import numpy as np
import pandas as pd

from comprope.errors import InputError

from ..files.cells.time_stamps import is_time_stamp, nanoseconds
from ..files.file_format import FileFormat
from ..files.raw_table import RawColumn, RawTable, printable
from .clock_columns import unnamed_clocks
from .numeric_times import numeric_times
from .times import TimeAxis


def time_axis(column: RawColumn, table: RawTable, stated: FileFormat) -> TimeAxis:
    """The times of a column; raises `InputError`, without the file's name, where they are not times or do not increase."""
    found = times_of(column, table, stated)
    _require_increasing(column, table, found)
    return found


def times_of(column: RawColumn, table: RawTable, stated: FileFormat) -> TimeAxis:
    """The times of a column in whatever order they stand."""
    return _stamps(column, table) if _is_stamped(column.values) else numeric_times(column, table, stated)


def first_column_times(column: RawColumn, table: RawTable, stated: FileFormat) -> TimeAxis:
    """The times in the first column of a table where none is named as one; raises `InputError` if it holds none."""
    first = table.columns[0]
    names = printable(", ".join(one.name for one in table.columns), 300)
    sentence = f'no column of times; the header has {names}: write time = "..." or rate = ... [Hz] under [file]'
    if first.name == column.name or len(first.values) != len(column.values):
        raise InputError(sentence)
    try:
        found = time_axis(first, table, stated)
    except InputError:
        raise InputError(sentence) from None
    if others := unnamed_clocks(table):
        raise InputError(f"{sentence}; {', '.join(one.name for one in (first, *others))} count evenly, as clocks do")
    return TimeAxis(found.seconds, found.origin, found.kind, found.unit, found.sure, f"{first.name} is taken as the time")


def _is_stamped(values: pd.Series) -> bool:
    if pd.api.types.is_datetime64_any_dtype(values) or pd.api.types.is_timedelta64_dtype(values):
        return True
    known = [one for one in values.head(200) if not pd.isna(one) and one != ""]
    texts = [one for one in known if not isinstance(one, str) or is_time_stamp(one)]
    return not pd.api.types.is_numeric_dtype(values) and len(known) > 0 and len(texts) > 0.5 * len(known)


def _stamps(column: RawColumn, table: RawTable) -> TimeAxis:
    values = column.values
    if pd.api.types.is_datetime64_any_dtype(values) or pd.api.types.is_timedelta64_dtype(values):
        if isinstance(values.dtype, pd.DatetimeTZDtype):
            values = values.dt.tz_convert(None)
        whole = values.astype("datetime64[ns]" if pd.api.types.is_datetime64_any_dtype(values) else "timedelta64[ns]")
        own, missing, dated = whole.astype("int64").to_numpy(), np.flatnonzero(values.isna()), True
    else:
        empty = values.map(lambda one: pd.isna(one) or one == "").to_numpy()
        own, wrong, dated = nanoseconds(values)
        missing = np.flatnonzero(empty)
        if bad := [k for k in wrong if not empty[k]]:
            raise InputError(
                f"{column.name} = {printable(repr(values.iloc[bad[0]]))} in {table.row_text(bad[0])}: "
                "a time is needed as in the other rows"
            )
    known = np.ones(len(own), bool)
    known[missing] = False
    first = int(own[np.argmax(known)])
    seconds = np.where(known, (own - first) / 1e9, np.nan)
    return TimeAxis(seconds, first / 1e9, "date" if dated else "clock")


def _require_increasing(column: RawColumn, table: RawTable, axis: TimeAxis) -> None:
    index = np.flatnonzero(np.isfinite(axis.seconds))
    t = axis.seconds[index]
    if len(t) < 2:
        raise InputError(f"{column.name}: {len(t)} times; a time in every row is needed")
    steps = np.diff(t)
    if np.all(steps > 0.0):
        return
    same, back = int(np.sum(steps == 0.0)), int(np.sum(steps < 0.0))
    where = table.row_text(int(index[1 + int(np.argmax(steps <= 0.0))]))
    if back:
        raise InputError(
            f"{column.name} in {where} must be later than the row before ({_rows(back)} earlier): several records in one file?"
        )
    raise InputError(
        f"{column.name} in {where} must be later than the row before ({_rows(same)} at the same time): if samples are even, "
        'write their rate [Hz] under [file] and leave out the time column with time = ""'
    )


def _rows(count: int) -> str:
    return f"{count} row is" if count == 1 else f"{count} rows are"
