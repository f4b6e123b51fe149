"""Numbers, percentages, wrapped text and plain tables."""

from collections.abc import Sequence
from textwrap import wrap

import numpy as np

from ...report.page import Table

WIDTH = 100  # of lines on a terminal
ZERO = 1e-9  # parameters of smaller size are shown as zero


def percent(share: float | None) -> str:
    """A share as a percentage of three digits; a dash where there is none."""
    return "–" if share is None or not np.isfinite(share) else f"{100.0 * share:.3g} %"


def number(value: float | None) -> str:
    """A number of three digits; a dash where there is none."""
    return "–" if value is None or not np.isfinite(value) else f"{float(f'{value:.3g}'):g}"


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
