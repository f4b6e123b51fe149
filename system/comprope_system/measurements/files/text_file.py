"""CSV and other text tables, also LabVIEW measurement files, in any dialect and encoding."""

import re
from collections.abc import Sequence
from functools import partial

from .dialect import TRIED_LINES, find_separator, locate, split_line
from .file_format import FileFormat
from .grid import table_at
from .plain_block import read_plain_block
from .raw_table import RawTable
from .text_encoding import decode
from .text_lines import Rows, TextLines

_FOR_SPREADSHEETS = re.compile(r"sep=.\s*", re.IGNORECASE)
_SEVERAL_BLANKS = re.compile(r"\s{2,}")
LABVIEW, LABVIEW_END = "LabVIEW Measurement", "***End_of_Header***"
_COMMA_STAMP = re.compile(r'^("?(?:[^,;\t]*[T ])?\d{1,2}:\d{2}:\d{2}),(\d{3,6})(?=["\s]*,)')


def read_text_table(data: bytes, stated: FileFormat) -> RawTable:
    """The table of a text file; raises `InputError`, without the file's name, if there is none."""
    text = decode(data, stated.encoding)
    lines: Sequence[str] = TextLines(text)
    if stated.header is None and len(lines) and lines[0].startswith(LABVIEW):
        stated = stated.model_copy(update={"header": _labview_header(lines)})
    separator, decimal = find_separator(lines, stated.separator, stated.decimal)
    if separator == ",":
        lines = _with_points_in_stamps(lines)
    rows = Rows(lines, partial(_cells, separator=separator))
    found = locate(rows, decimal, stated.header)
    block = None
    if isinstance(lines, TextLines):
        block = read_plain_block(lines, found, separator, decimal)
    return table_at(rows, found, decimal, block)


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
        return _SEVERAL_BLANKS.split(line.strip())
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
