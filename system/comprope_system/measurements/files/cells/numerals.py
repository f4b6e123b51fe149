"""Cells of text tables: numbers in any notation, and words that stand for no value."""

import re
from collections.abc import Sequence

import numpy as np
import pandas as pd

# What loggers and spreadsheets write where there is no value; compared without case, blanks and punctuation around it.
MISSING_WORDS = frozenset(
    [
        "nan", "na", "n/a", "null", "none", "nil", "nv", "invalid", "bad", "error", "err", "fault", "missing", "undefined",
        "undef", "ovl", "ovf", "ovr", "over", "overflow", "overrange", "over-range", "overload", "under", "underflow",
        "underrange", "under-range", "ol", "+ol", "-ol", "unf", "ufl", "sat", "saturated", "open", "disconnected", "lost",
        "offline", "timeout", "#n/a", "#na", "#value", "#value!", "#num!", "#div/0!", "#ref!", "1.#qnan", "1.#ind", "1.#inf",
        "1.#inf00", "-1.#ind", "-1.#inf", "keine", "fehler", "burnout", "+over", "-over", "ungültig",
    ]
)
MISSING_PHRASES = frozenset({"no data", "no value", "no signal", "not available", "out of range", "kein wert"})
INFINITE_WORDS = frozenset(["inf", "+inf", "-inf", "infinity", "+infinity", "-infinity", "∞", "+∞", "-∞"])
_DASHES = re.compile(r"[-–—_.*?=/\s]*")
_MINUS = str.maketrans({"−": "-", "\u00a0": " ", "\u202f": " ", "\u2009": " "})
_NUMBER = {
    sign: re.compile(
        rf"(?:[+-]\s*)?(?:\d+(?:{re.escape(sign)}\d*)?|{re.escape(sign)}\d+"
        rf"|[1-9]\d{{0,2}}(?:[{other}'’ ]\d{{3}})+(?:{re.escape(sign)}\d*)?)"
        r"(?:[eEdD][+-]?\d+)?"
    )
    for sign, other in ((".", ","), (",", "."))
}
_BEGINNINGS = frozenset("+-.,0123456789")


def is_number(cell: str, decimal: str) -> bool:
    """Whether a cell is a number with this decimal sign; thousands may be separated by the other, a blank or an apostrophe.

    A number that begins with 0 has no thousands: "0,123" is 0.123, with a decimal comma.
    """
    if cell[:1] in _BEGINNINGS and _is_plain(cell, decimal):
        return True
    return bool(_NUMBER[decimal].fullmatch(cell.translate(_MINUS).strip()))


def _is_plain(cell: str, decimal: str) -> bool:
    """Whether a cell is a number as Python writes it, but for the decimal sign: nearly all are, and this is quick."""
    if (decimal != "." and "." in cell) or "_" in cell or not cell.isascii():
        return False
    try:
        float(cell if decimal == "." else cell.replace(decimal, "."))
    except ValueError:
        return False
    return cell[-1:].isdigit() or cell[-1:] == decimal


def is_missing(cell: str, words: Sequence[float | str] = ()) -> bool:
    """Whether a cell is empty, dashes, a known word for no value, or one of the stated `words`."""
    text = cell.strip().strip("<>[]()\"'").strip().lower()
    known = text in MISSING_WORDS or text in MISSING_PHRASES
    return known or bool(_DASHES.fullmatch(text)) or text in {str(one).strip().lower() for one in words}


def is_infinite(cell: str) -> bool:
    """Whether a cell is written as infinity."""
    return cell.strip().lower() in INFINITE_WORDS


def parse(cell: str, decimal: str) -> float:
    """The number of a cell for which `is_number` is true."""
    other = "," if decimal == "." else "."
    text = re.sub(rf"[{other}'’ ]", "", cell.translate(_MINUS).strip()).replace(decimal, ".")
    return float(text.replace("D", "E").replace("d", "e"))


def to_numbers(values: pd.Series, decimal: str, words: Sequence[float | str]) -> tuple[pd.Series, list[int], dict[str, int]]:
    """Numbers (n,) of a text column, the indices of cells that are neither numbers nor missing, and the count of each word.

    Cells of the plain notation are converted by pandas, as `read_csv` does it.
    """
    texts = values.where(values.notna(), "").astype(str).str.strip()
    if decimal == ",":
        texts_with_points = texts.str.replace(",", ".", regex=False)
        plain = texts_with_points.where(~texts.str.contains(".", regex=False), "")
    else:
        plain = texts
    found = pd.to_numeric(plain, errors="coerce").astype(float)
    wrong, counts = [], dict[str, int]()
    for k in np.flatnonzero(~np.isfinite(found.to_numpy()) & (texts != "").to_numpy()):
        cell = texts.iloc[k]
        if is_number(cell, decimal):
            found.iloc[k] = parse(cell, decimal)
        elif is_infinite(cell):
            found.iloc[k] = -np.inf if cell.startswith("-") else np.inf
        elif not is_missing(cell, words):
            wrong.append(int(k))
        elif cell:
            counts[cell] = counts.get(cell, 0) + 1
    return found, wrong, counts
