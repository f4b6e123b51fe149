"""Excel workbooks (.xlsx)."""

from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any

import openpyxl

from comprope.errors import InputError

from ..cells.dialect import find_decimal
from ..cells.table import table_of
from ..file_format import FileFormat
from ..raw_table import RawTable


def read(path: Path, stated: FileFormat) -> RawTable:
    """The table of the stated sheet, otherwise of the only one that holds a table of numbers."""
    book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    try:
        names = [sheet.title for sheet in book.worksheets]
        if stated.sheet is not None and stated.sheet not in names:
            raise InputError(f'file.sheet = "{stated.sheet}": a sheet of the workbook is accepted: {", ".join(names)}')
        found, problems = {}, []
        for sheet in book.worksheets:
            if stated.sheet == sheet.title or (stated.sheet is None and sheet.sheet_state == "visible"):
                try:
                    rows = [[_text(cell) for cell in row] for row in sheet.iter_rows(values_only=True)]
                    found[sheet.title] = table_of(rows, stated.decimal or find_decimal(rows), stated)
                except InputError as error:
                    problems.append(f"sheet {sheet.title}: {error}")
    finally:
        book.close()
    if not found:
        raise InputError("; ".join(problems) or "the workbook has no sheet")
    if len(found) > 1:
        raise InputError(f'several sheets hold tables: {", ".join(found)}; write sheet = "{next(iter(found))}" under [file]')
    return next(iter(found.values()))


def _text(cell: Any) -> str:
    if cell is None:
        return ""
    if isinstance(cell, float):
        return repr(int(cell)) if cell.is_integer() and abs(cell) < 1e15 else repr(cell)
    if isinstance(cell, datetime | date | time):
        return cell.isoformat()
    if isinstance(cell, timedelta):
        seconds = cell.total_seconds()
        return f"{int(seconds // 3600)}:{int(seconds % 3600 // 60):02d}:{seconds % 60:09.6f}"
    return str(cell).strip()
