"""The rows of a table that is written plainly, read by pandas at once: no quotation marks, as many cells in every row."""

import io

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ..cells.dialect import split_line
from ..cells.table_lines import COMMENTS, TableLines
from .lines import TextLines

FEWEST = 100  # rows from which on it matters
DIGITS = (1e12, 1e15)  # numbers with a fraction beside so many digits may be digits of a date, which a double does not hold


def read_plain_block(lines: TextLines, found: TableLines, separator: str, decimal: str) -> pd.DataFrame | None:
    """The columns of a table whose lines were found: numbers where a column has no other cells, otherwise texts.

    None for a short table, and for one with quotation marks, comments, empty or repeated lines or rows of other lengths: these
    are read row by row, and one with digits of dates.
    """
    first, last, width = found.first, found.last, found.width
    if last - first < FEWEST or separator == " " or (lines.counts(separator, first, last) != width - 1).any():
        return None
    block = lines.block(first, last)
    if b'"' in block or b"\0" in block:
        return None
    try:
        read = pd.read_csv(
            io.BytesIO(block), sep=separator, decimal=decimal, header=None, names=range(width), index_col=False, na_values=[""],
            keep_default_na=False, skipinitialspace=True, low_memory=False, quoting=3,
        )  # fmt: skip
    except (ValueError, UnicodeError):
        return None
    if any(_has_many_digits(read[k].to_numpy()) for k in read if read[k].dtype.kind == "f"):
        return None
    texts = [k for k in read if read[k].dtype.kind not in "iuf"]
    for k in texts:
        read[k] = read[k].map(lambda one: "" if one != one else str(one).strip()).astype(str)
    return read if len(read) == last - first + 1 and not _interrupted(read, texts, lines, found, separator) else None


def _interrupted(read: pd.DataFrame, texts: list[int], lines: TextLines, found: TableLines, separator: str) -> bool:
    """Whether some rows are empty, comments, or repeat the lines of names or units."""
    if 0 in texts and read[0].str.startswith(COMMENTS).any():
        return True
    empty = [(read[k] == "") if k in texts else read[k].isna() for k in read]
    headers = [split_line(lines[k], separator) for k in (found.header, found.units) if k is not None]
    repeated = any((read[k] == row[k]).any() for row in headers for k in texts if k < len(row) and found.numeric[k])
    return repeated or bool(np.logical_and.reduce(empty).any())


def _has_many_digits(values: NDArray[np.float64]) -> bool:
    large = values[(np.abs(values) > DIGITS[0]) & (np.abs(values) < DIGITS[1])]
    return bool((large != np.round(large)).any())
