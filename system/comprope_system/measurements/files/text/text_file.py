"""CSV and other text tables, also LabVIEW measurement files, in any dialect and encoding."""

import re
from collections.abc import Sequence
from functools import partial

from comprope.errors import InputError

from ..cells.dialect import TRIED_LINES, find_separator, split_line
from ..cells.numerals import is_number
from ..cells.table import table_at
from ..cells.table_lines import COMMENTS, TableLines, locate
from ..file_format import FileFormat
from ..raw_table import RawTable
from .encoding import decode
from .lines import Rows, TextLines
from .plain_block import read_plain_block

_FOR_SPREADSHEETS = re.compile(r"sep=.\s*", re.IGNORECASE)
_SEVERAL_BLANKS = re.compile(r"\s{2,}")
_QUOTED_LINES = re.compile(r'"[^"]{1,200}"')
HEAD = 20_000  # characters at the beginning in which names are looked for
LABVIEW, LABVIEW_END = "LabVIEW Measurement", "***End_of_Header***"
_COMMA_STAMP = re.compile(r'^("?(?:[^,;\t]*[T ])?\d{1,2}:\d{2}:\d{2}),(\d{3,6})(?=["\s]*,)')


def read_text_table(data: bytes, stated: FileFormat) -> RawTable:
    """The table of a text file; raises `InputError`, without the file's name, if there is none."""
    text = _with_names_in_one_line(decode(data, stated.encoding))
    lines: Sequence[str] = TextLines(text)
    if stated.header is None and len(lines) and lines[0].startswith(LABVIEW):
        stated = stated.model_copy(update={"header": _labview_header(lines)})
    separator, decimal = find_separator(lines, stated.separator, stated.decimal)
    if separator == ",":
        lines = _with_points_in_stamps(lines)
    rows = Rows(lines, partial(_cells, separator=separator))
    found = locate(rows, decimal, stated.header)
    if separator == " ":
        _require_whole_rows(rows, found, decimal)
    block = None
    if isinstance(lines, TextLines):
        block = read_plain_block(lines, found, separator, decimal)
    return table_at(rows, found, decimal, block)


def _with_names_in_one_line(text: str) -> str:
    """The text with blanks in place of line ends within quoted names, as spreadsheets write them."""
    head = text[:HEAD]
    if all(line.count('"') % 2 == 0 for line in head.splitlines()[:-1]):
        return text
    return _QUOTED_LINES.sub(lambda match: " ".join(match[0].split()), head) + text[HEAD:]


def _require_whole_rows(rows: Rows, found: TableLines, decimal: str) -> None:
    """Raise `InputError` for a row between blanks that lacks cells: which ones, nobody can say."""
    for k in range(found.first, len(rows)):
        if 2 <= len(rows[k]) < found.width and all(is_number(cell, decimal) for cell in rows[k]):
            raise InputError(
                f"{len(rows[k])} cells in row {k + 1}, {found.width} in others: between blanks, a missing value needs a word, "
                "such as NaN"
            )


def _labview_header(lines: Sequence[str]) -> int | None:
    """The line of the names in a LabVIEW measurement file, from 1: the one after the headers, whose lines hold numbers too."""
    ends = [k for k, line in enumerate(lines) if line.startswith(LABVIEW_END)]
    return ends[-1] + 2 if ends else None


def _cells(line: str, separator: str) -> list[str]:
    """The cells of a line; between blanks, names that hold single blanks are separated by several."""
    if _FOR_SPREADSHEETS.fullmatch(line):
        return []
    cells = split_line(line, separator)
    if separator == " " and not any(cell[:1].isdigit() or cell[:1] in "+-" for cell in cells):
        names = _SEVERAL_BLANKS.split(line.strip())
        return names if len(names) > 1 or not line.startswith(COMMENTS) else cells
    return cells


def _with_points_in_stamps(lines: Sequence[str]) -> Sequence[str]:
    """Lines in which "09:12:01,123," is "09:12:01.123,", unless the header has a name for each of the two cells."""
    sample = lines[:TRIED_LINES]
    stamped = [k for k, line in enumerate(sample) if _COMMA_STAMP.match(line)]
    if len(stamped) < 0.5 * len(sample):
        return lines
    width = len(split_line(lines[stamped[0]], ","))
    if any(len(split_line(line, ",")) == width for line in lines[: stamped[0]]):
        return lines
    return [_COMMA_STAMP.sub(r"\1.\2", line) for line in lines]
