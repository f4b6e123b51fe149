"""Numbers, percentages, wrapped text and plain tables."""

from collections.abc import Sequence
from textwrap import wrap

import numpy as np

from ...report.page import Table

WIDTH = 100  # of lines on a terminal
NOTHING = 1e-9  # parameters below it are told as zero


def percent(share: float | None) -> str:
    """A share as a percentage of three digits; a dash where there is none."""
    return "–" if share is None or not np.isfinite(share) else f"{100.0 * share:.3g} %"


def number(value: float | None) -> str:
    """A number of three digits; a dash where there is none."""
    return "–" if value is None or not np.isfinite(value) else f"{value:.3g}"


def wrapped(*sentences: str) -> list[str]:
    """Sentences as lines for a terminal."""
    return [line for sentence in sentences for line in wrap(sentence, WIDTH)]


def chance(probability: float) -> str:
    """A probability; none is certain."""
    return "over 0.99" if probability > 0.99 else f"{probability:.2f}" if probability >= 0.01 else "under 0.01"


def plain_table(table: Table) -> list[str]:
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
