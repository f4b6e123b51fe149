"""Numbers, percentages, wrapped text and plain tables."""

from collections.abc import Sequence
from textwrap import wrap

import numpy as np

from ....report.page import Table

WIDTH = 100  # of lines on a terminal
HANDY_UNITS = (  # SI unit, from and below which largest value, factor, unit
    ("m", 0.0, 1.0, 1e3, "mm"), ("m/s", 0.0, 1.0, 1e3, "mm/s"), ("s", 0.0, 1.0, 1e3, "ms"), ("N", 1e4, 1e12, 1e-3, "kN"),
    ("N.s/m", 1e4, 1e12, 1e-3, "kN·s/m"), ("N.m", 1e4, 1e12, 1e-3, "kN·m"),
)  # fmt: skip
ZERO = 1e-9  # parameters of smaller size are shown as zero


def percent(share: float | None) -> str:
    """A share as a percentage of three digits; a dash where there is none."""
    return "–" if share is None or not np.isfinite(share) else f"{100.0 * share:.3g} %"


def number(value: float | None) -> str:
    """A number of three digits; a dash where there is none."""
    return "–" if value is None or not np.isfinite(value) else f"{float(f'{value:.3g}'):g}"


def in_handy_unit(unit: str, *values: float) -> tuple[str, ...]:
    """Values [SI unit] as texts of three digits in one handy unit: millimetres, milliseconds, kilonewtons."""
    factor, shown = handy_unit(unit, max(map(abs, values)))
    return tuple(f"{number(value * factor)} {shown}".strip() for value in values)


def handy_unit(unit: str, size: float) -> tuple[float, str]:
    """Factor and name of the handy unit for values [SI unit] up to this size; no name for a pure number."""
    return next(
        ((by, name) for of, least, most, by, name in HANDY_UNITS if of == unit and least <= size < most),
        (1.0, "" if unit == "1" else unit.replace(".", "·")),
    )


def listed_words(words: Sequence[str]) -> str:
    """Words as a list in a sentence."""
    return " and ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else "".join(words)


def wrapped(*sentences: str) -> list[str]:
    """Sentences as lines for a terminal."""
    return [line for sentence in sentences for line in wrap(sentence, WIDTH)]


def probability(value: float) -> str:
    """A probability of two digits; none is shown as certain."""
    return "over 0.99" if value > 0.99 else f"{value:.2f}" if value >= 0.01 else "under 0.01"


def text_table(table: Table) -> list[str]:
    """A table as lines of text."""
    cells: Sequence[Sequence[str]] = [list(table.head), *table.rows]
    widths = [max(len(row[k]) for row in cells) for k in range(len(table.head))]
    lines = []
    for row in cells:
        padded = (
            cell.rjust(w) if table.numeric(k) else cell.ljust(w) for k, (cell, w) in enumerate(zip(row, widths, strict=True))
        )
        lines.append("  ".join(padded).rstrip())
    return lines


def listed(title: str, items: Sequence[str]) -> list[str]:
    """Items under a title as lines of text; no line where there is no item."""
    return [title, *(f"  {item}" for item in items)] if items else []


def paragraphs(*texts: Sequence[str]) -> str:
    """Groups of lines as one text, an empty line between them; empty groups are left out."""
    return "\n\n".join("\n".join(lines) for lines in texts if lines)
