"""Tables whose cells are coloured by size and lead to their curves."""

from bisect import bisect
from collections.abc import Sequence
from dataclasses import dataclass

LEVELS = (0.05, 0.1, 0.2, 0.5, 1.0)  # limits of the colours, as shares; a constant in place of the model has an NRMSE of 1


@dataclass(frozen=True)
class Target:
    """The panel to which a cell leads: figure, numbers of group and panel in it, name of the span of its axis (or empty)."""

    curves: str
    group: int
    panel: int
    span: str = ""


@dataclass(frozen=True)
class HeatCell:
    """A number with the level of its colour, 0 for none; `title` is told under the pointer."""

    text: str
    level: int = 0
    title: str = ""
    target: Target | None = None


@dataclass(frozen=True)
class HeatMap:
    """A table of texts and coloured cells, whose first `labels` columns name its rows; a row of one text heads those after it."""

    head: Sequence[str]
    heat_rows: Sequence[Sequence[str | HeatCell]]
    labels: int = 1
    caption: str = ""


def level_of(share: float) -> int:
    """The level of a share, from 0 (no colour) to 5."""
    return bisect(LEVELS, share) if share == share else 0


def level_sentence() -> str:
    """What the colours mean."""
    return f"Colours change at {', '.join(f'{100.0 * one:g}' for one in LEVELS)} %."
