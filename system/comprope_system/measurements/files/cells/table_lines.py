"""Where a table stands in a file: the lines of names, units, and first and last numbers."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

from comprope.errors import InputError

from ...units import is_unit
from .dialect import LEAST_VALUES, Cells, is_value, sampled_rows
from .numerals import is_infinite, is_missing, is_number

COMMENTS = ("#", "%", "//", "!", "*")
FOLLOWERS, FOLLOWING = 20, 0.93  # rows after the first one of a table that are looked at, and share of them that are rows too
SEARCHED = 100  # rows with numbers within which a table begins: settings above it may hold numbers too
NUMERIC_SHARE = 0.5  # of a column's cells from which on it is a column of numbers


@dataclass(frozen=True)
class TableLines:
    """Where a table stands: indices from 0 of the lines of names, units, and first and last numbers; `width` cells in each row.

    `numeric` (width,) are the columns that hold numbers or times, in contrast to texts. `others` are further lines of
    names, such as descriptions.
    """

    header: int | None
    units: int | None
    first: int
    last: int
    width: int
    numeric: tuple[bool, ...]
    others: tuple[int, ...] = ()


def locate(rows: Sequence[Cells], decimal: str, header: int | None) -> TableLines:
    """Where header, units and numbers stand; `header` is a stated line of names, from 1. Raises `InputError` without a table."""
    sampled = sampled_rows(len(rows))
    width = _usual_width([rows[k] for k in sampled], decimal)

    def is_candidate(k: int) -> bool:
        return len(trimmed(rows[k], width)) == width and _values(rows[k], decimal) >= LEAST_VALUES

    below = [k for k in sampled if k >= (header or 0) and is_candidate(k)]
    numeric = _numeric_columns([rows[k] for k in below], width, decimal)
    good = (k for k in range(header or 0, len(rows)) if is_candidate(k) and fits(rows[k], numeric, decimal))
    first = _first_row(rows, [*islice(good, SEARCHED)], decimal) if below else None
    if first is None:
        raise InputError("no table of numbers: no row in which the columns hold a time and numbers")
    # A footer has a word where rows have the time; a row with a bad cell elsewhere is a row.
    key = numeric.index(True)
    last = next(k for k in reversed(range(len(rows))) if k == first or _is_row(rows[k], key, width, decimal))
    while first > (header or 0) and _is_row(rows[first - 1], key, width, decimal):
        first -= 1
    start = header if header is not None else 0
    above = [k for k in range(start, first) if rows[k]]
    # Of several lines of units, those of time for instance, it is the one whose cells differ most.
    united = [k for k in reversed(above) if _is_units_row(trimmed(rows[k], width))]
    units = max(united, key=lambda k: len(set(rows[k])), default=None)
    if header is not None:
        units = next((k for k in range(header - 1) if _is_units_row(trimmed(rows[k], width))), units)
        return TableLines(header - 1, units, first, last, width, numeric)
    names = [k for k in above if k != units and _is_header(uncommented(rows[k]), width, decimal)]
    # Of several lines, kinds and settings below the names, it is the one whose cells differ most.
    name = max(reversed(names), key=lambda k: len(set(rows[k]) - {""}), default=None)
    return TableLines(name, units, first, last, width, numeric, tuple(k for k in names if k != name))


def _first_row(rows: Sequence[Cells], good: Sequence[int], decimal: str) -> int | None:
    """The first of the good rows that begins a table; None if there is none.

    Settings above a table may hold numbers in its columns too: the table begins below a line without numbers, and nearly all rows
    after its first are good.
    """
    known = set(good)
    for k in good[: SEARCHED - FOLLOWERS]:
        followers = [j for j in range(k, min(k + 2 * FOLLOWERS, len(rows))) if any(rows[j])][:FOLLOWERS]
        below = k == 0 or _values(rows[k - 1], decimal) < LEAST_VALUES
        if below and sum(j in known for j in followers) >= FOLLOWING * len(followers):
            return k
    return good[0] if good else None


def _is_row(row: Cells, key: int, width: int, decimal: str) -> bool:
    if len(row) <= key or len(trimmed(row, width)) != width:
        return False
    # A slower clock may have no time left where another one still has.
    return is_value(row[key], decimal) or (is_missing(row[key]) and _values(row, decimal) >= LEAST_VALUES)


def _values(row: Cells, decimal: str) -> int:
    return sum(is_value(cell, decimal) for cell in row)


def _usual_width(rows: Sequence[Cells], decimal: str) -> int:
    """Most frequent number of cells among rows with two numbers, without unnamed cells that are empty in all of them."""
    numbers = [(k, row) for k, row in enumerate(rows) if _values(row, decimal) >= LEAST_VALUES]
    if not numbers:
        return 0
    width = Counter(len(row) for _, row in numbers).most_common(1)[0][0]
    own = [(k, row) for k, row in numbers if len(row) == width]
    named = max((len(trimmed(row, 0)) for row in rows[: own[0][0]]), default=0)
    while width > max(2, named) and all(not row[width - 1] for _, row in own):
        width -= 1
    return width


def trimmed(row: Cells, width: int) -> Cells:
    """The row without empty cells beyond `width`."""
    end = len(row)
    while end > width and not row[end - 1]:
        end -= 1
    return row[:end]


def _numeric_columns(rows: Sequence[Cells], width: int, decimal: str) -> tuple[bool, ...]:
    """Which columns hold numbers or times, by the share of cells that are not empty."""
    found = []
    for k in range(width):
        cells = [row[k] for row in rows if k < len(row) and not is_missing(row[k])]
        numbers = sum(is_value(cell, decimal) or is_infinite(cell) for cell in cells)
        found.append(bool(cells) and numbers >= NUMERIC_SHARE * len(cells))
    return tuple(found)


def fits(row: Cells, numeric: Sequence[bool], decimal: str) -> bool:
    """Whether a row holds a number, a time or no value wherever its column holds numbers."""
    own = [cell for cell, one in zip(row, numeric, strict=False) if one]
    return all(is_value(cell, decimal) or is_missing(cell) or is_infinite(cell) for cell in own)


def _is_units_row(row: Cells) -> bool:
    """Whether most cells of a row are units of measurement, in brackets or not, and the others empty."""
    cells = [cell for cell in row if cell.strip("[]() -1")]
    return len(cells) >= 2 and sum(is_unit(cell) for cell in cells) > 0.6 * len(cells)


def _is_header(row: Cells, width: int, decimal: str) -> bool:
    """Whether a row may hold the names of the columns: as many cells as there are columns, most of them not numbers."""
    own = trimmed(row, width)
    if len(own) == width + 1 and own[-1].lower() == "comment":  # LabVIEW names a column that its rows leave out
        own = own[:-1]
    named = sum(bool(cell) and not is_number(cell, decimal) for cell in own)
    return len(own) == width and named > 0.5 * width


def uncommented(row: Cells) -> Cells:
    """The cells of a line without a mark of comments before the first, whether or not it stands in a cell of its own."""
    if not row or not row[0].startswith(COMMENTS):
        return row
    first = row[0].lstrip("".join(COMMENTS)).strip()
    return [first, *row[1:]] if first else row[1:]
