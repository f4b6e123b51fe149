"""A table from rows of text cells: which rows are the table, and its columns with names and units."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from comprope.errors import InputError

from ...units import is_unit, unit_like
from ..file_format import FileFormat
from ..raw_table import RawColumn, RawTable, unique_names
from .dialect import Cells
from .numerals import is_number
from .sample_rate import stated_rate
from .table_lines import COMMENTS, TableLines, fits, locate, trimmed, uncommented


def table_of(rows: Sequence[Cells], decimal: str, stated: FileFormat) -> RawTable:
    """The table in rows of cells, and what was skipped around and within it; raises `InputError`, without the file's name."""
    return table_at(rows, locate(rows, decimal, stated.header), decimal)


def table_at(rows: Sequence[Cells], found: TableLines, decimal: str, block: pd.DataFrame | None = None) -> RawTable:
    """The table whose lines were found; `block` are its columns, if its rows were read already."""
    within, left = _within(rows, found) if block is None else ([*range(found.first, found.last + 1)], [])
    short, after = _around(rows, found, decimal)
    remarks = [*left, *after]
    kept = [*within, *short]
    if block is None or short:
        block = pd.DataFrame([[*rows[k][: found.width], *[""] * (found.width - len(rows[k]))] for k in kept], dtype=str)
    if found.header is None:
        _require_unsplit_header(rows, found, decimal)
        remarks.append("no line of column names above the numbers; columns are named column 1, column 2, ...")
    names = uncommented(rows[found.header])[: found.width] if found.header is not None else []
    names = unique_names([*names, *[""] * (found.width - len(names))])
    units = _units(rows[found.units], found.width) if found.units is not None else [None] * found.width
    others = [uncommented(rows[k]) for k in found.others]
    columns = tuple(
        RawColumn(name, block[k], unit, aliases=tuple(row[k] for row in others if k < len(row) and row[k]))
        for k, (name, unit) in enumerate(zip(names, units, strict=True))
    )
    return RawTable(columns, stated_rate(rows[: found.first]), np.array(kept) + 1, decimal, tuple(remarks))


def _require_unsplit_header(rows: Sequence[Cells], found: TableLines, decimal: str) -> None:
    """Raise `InputError` if the line above the numbers has names, but fewer than a row has cells."""
    above = next((rows[k] for k in range(found.first - 1, -1, -1) if rows[k]), [])
    if 2 <= len(above) < found.width and not any(is_number(cell, decimal) for cell in above):
        raise InputError(
            f"rows have {found.width} cells, but the line above has {len(above)} names: decimal commas between commas? Write the "
            "table with semicolons or decimal points"
        )


def _within(rows: Sequence[Cells], found: TableLines) -> tuple[list[int], list[str]]:
    """Indices of the rows of the table, and remarks about comments and repeated headers between them, and rows that end early."""
    kept, skipped, early = [], 0, 0
    repeated = [rows[k] for k in (found.header, found.units) if k is not None]
    for k in range(found.first, found.last + 1):
        row = rows[k]
        if not any(row) or row[0].startswith(COMMENTS) or row in repeated:
            skipped += bool(row)
        elif len(trimmed(row, found.width)) > found.width:
            names = f"{found.width} columns" if found.header is None else f"the header has {found.width} names"
            raise InputError(f"{len(trimmed(row, 0))} cells in row {k + 1}, but {names}: a separator that is also in the cells?")
        else:
            kept.append(k)
            early += len(row) < found.width
    remarks = [f"{_lines(skipped)} within the table skipped: comments or a repeated header"] if skipped else []
    if early:
        remarks.append(f"{_lines(early)} with fewer cells than names; the missing ones, at the end, are taken as empty")
    return kept, remarks


def _around(rows: Sequence[Cells], found: TableLines, decimal: str) -> tuple[list[int], list[str]]:
    """Indices of rows after the table that belong to it, and remarks about lines that are left out."""
    after = [k for k in range(found.last + 1, len(rows)) if any(rows[k])]
    # Rows without their last, empty cells belong to the table, but a torn last line holds a torn number.
    short = [k for k in after[:-1] if 2 <= len(rows[k]) < found.width and fits(rows[k], found.numeric, decimal)]
    remarks = []
    if left := len(after) - len(short):
        remarks.append(f"{_lines(left)} after the table (from line {after[-1] + 1}) not read as numbers")
    return short, remarks


def _lines(count: int) -> str:
    return f"{count} line" if count == 1 else f"{count} lines"


def _units(row: Cells, width: int) -> list[str | None]:
    own = [*row[:width], *[""] * (width - len(row))]
    return [cell.strip("[]() ") if is_unit(cell) or unit_like(cell) else None for cell in own]
