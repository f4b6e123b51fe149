"""Columns of a run that describe the motion of the rope's ends, and which of them acts."""

from collections.abc import Iterable

import pandas as pd

ENDS = ("car", "counterweight")
# Quantities of an end's vertical motion and how often each is integrated to a height; of several the first acts.
VERTICAL: dict[str, int] = {"position": 0, "speed": 1, "velocity": 1, "acceleration": 2}
LATERAL = "lateral_displacement"
COLUMNS = tuple(f"{end}_{quantity}" for end in ENDS for quantity in (*VERTICAL, LATERAL))


def vertical_column(table: pd.DataFrame, end: str) -> str | None:
    """The column that gives an end's height most directly; one without numbers only if there is no other."""
    present = [name for quantity in VERTICAL if (name := f"{end}_{quantity}") in table]
    return next((name for name in present if _has_numbers(table, name)), present[0] if present else None)


def lateral_column(table: pd.DataFrame, end: str) -> str | None:
    """The column of an end's lateral displacement, if it has numbers."""
    return name if _has_numbers(table, name := f"{end}_{LATERAL}") else None


def _has_numbers(table: pd.DataFrame, name: str) -> bool:
    return name in table and bool(table[name].notna().any())


def acting_columns(table: pd.DataFrame) -> set[str]:
    """The columns that determine the motion of the ends."""
    vertical = {name for end in ENDS if (name := vertical_column(table, end))}
    vertical = {name for name in vertical if _has_numbers(table, name)} or vertical
    if any(name.endswith("_position") for name in vertical):
        # A height of one end needs no integrated speed of the other, which drifts.
        vertical = {name for name in vertical if name.endswith("_position")}
    elif len(vertical) > 1:
        vertical = {name for name in vertical if name.startswith("car")}
    return vertical | {name for end in ENDS if (name := lateral_column(table, end))}


def idle_columns(table: pd.DataFrame, described: Iterable[str]) -> list[str]:
    """Columns that name a motion of an end and determine nothing, apart from the `described` ones."""
    used = {*acting_columns(table), *described}
    named = (str(name) for name in table.columns if str(name) not in used)
    return [name for name in named if name in COLUMNS or _speaks_of_motion(name)]


def _speaks_of_motion(name: str) -> bool:
    """Whether a name looks like one of an end's lateral motion in another spelling."""
    small = name.lower()
    return "lateral" in small and any(small.startswith(end) for end in ("car", "counterweight", "cw"))
