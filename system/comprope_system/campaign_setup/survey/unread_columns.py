"""Columns of texts that look like numbers: they would be channels, if they could be read."""

import re
from collections.abc import Collection, Iterator

from ...measurements.columns.column_names import is_time_name
from ...measurements.files.cells.time_stamps import is_time_stamp
from ...measurements.files.raw_table import RawColumn, RawTable, printable

LOOKED_AT = 200  # cells that tell
DATE = re.compile(r"\d{1,4}[-./]\d{1,2}[-./]\d{1,4}")
NUMBER = re.compile(r"\W{0,3}\d")  # the beginning of a cell that may be a number: '12.5, (3.1), 4.2 mm


def unread_columns(table: RawTable, file: str, read: Collection[str]) -> Iterator[str]:
    """Sentences about columns of a file that were not `read` and whose cells mostly begin like numbers."""
    for column in table.columns:
        if column.name in read or column.is_numeric or is_time_name(column.name):
            continue
        cells = _cells(column)
        if sum(bool(NUMBER.match(one)) for one in cells) > 0.5 * len(cells):
            cell = next((one for one in cells if not _is_plain(one)), cells[0])
            yield f"{printable(file)}: {column.name}: left out, because cells such as {printable(repr(cell), 40)} are no numbers"


def _cells(column: RawColumn) -> list[str]:
    """Cells that are not empty; none of a column of dates or times."""
    cells = [one.strip() for one in column.values if isinstance(one, str) and one.strip()]
    return [] if all(is_time_stamp(one) or DATE.fullmatch(one) for one in cells[:LOOKED_AT]) else cells


def _is_plain(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
