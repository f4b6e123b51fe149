"""The dialect of a text table: separator and decimal sign.

Each pair of them is tried; the one with which most cells of rows of equal length are numbers is taken.
"""

import csv
import io
from collections import Counter
from collections.abc import Sequence

from comprope.errors import InputError

from .numerals import is_number
from .time_stamps import is_time_stamp

SEPARATORS = (",", ";", "\t", "|", " ")
TRIED_LINES = 400  # lines at the beginning from which separator and decimal sign are found
LEAST_ROWS = 1  # of numbers that make a table
LEAST_VALUES = 2  # numbers or times in a row of a table
Cells = list[str]


def split_line(line: str, separator: str) -> Cells:
    """The cells of a line, without quotation marks and blanks around them."""
    if separator == " ":
        return line.split()
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    try:
        return [cell.strip() for cell in next(csv.reader(io.StringIO(line), delimiter=separator, skipinitialspace=True), [])]
    except csv.Error:
        return [cell.strip() for cell in line.split(separator)]


def find_separator(lines: Sequence[str], separator: str | None, decimal: str | None) -> tuple[str, str]:
    """Separator and decimal sign of a text; what is stated is taken as it is. Raises `InputError`, without a file's name."""
    quoted = any('"' in line for line in lines[:TRIED_LINES])
    tried = [
        (own, sign)
        for own in ([separator] if separator else SEPARATORS)
        for sign in ([decimal] if decimal else (".", ","))
        if own != sign or quoted
    ]
    sampled = [lines[k] for k in sampled_rows(len(lines))]
    scores = {one: _score([split_line(line, one[0]) for line in sampled if line.strip()], one[1]) for one in tried}
    best = max(tried, key=lambda one: scores[one], default=None)
    if best is None or scores[best] <= 0:
        raise InputError("no table of numbers: rows of at least two cells, with a time and numbers, are accepted")
    return best


def find_decimal(rows: Sequence[Cells]) -> str:
    """The decimal sign with which more cells of a sheet are numbers."""
    return max((".", ","), key=lambda sign: _score(rows[:TRIED_LINES], sign))


def _score(rows: Sequence[Cells], decimal: str) -> int:
    """Number of cells that are numbers or times in rows of the most frequent length."""
    counts = [(len(row), sum(is_value(cell, decimal) for cell in row)) for row in rows]
    cells, numbers = Counter[int](), Counter[int]()
    for width, number in counts:
        if number >= LEAST_VALUES:
            cells[width] += 1
            numbers[width] += number
    usual = max(numbers, key=lambda width: numbers[width], default=0)
    return numbers[usual] if cells[usual] >= LEAST_ROWS else 0


def is_value(cell: str, decimal: str) -> bool:
    """Whether a cell is a number or a time."""
    return is_number(cell, decimal) or is_time_stamp(cell)


def sampled_rows(count: int) -> list[int]:
    """Indices of the rows from which width and kinds of the columns are found: those of the beginning, and some of the middle."""
    middle = max(count // 2, TRIED_LINES)
    return [*range(min(count, TRIED_LINES)), *range(middle, min(count, middle + TRIED_LINES))]
