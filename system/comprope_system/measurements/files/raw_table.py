"""The table of a file before its columns are interpreted: names, units as written, numbers or texts."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd


@dataclass(frozen=True)
class RawColumn:
    """A column as the file has it: `values` (n,) are numbers, or texts where some cell is no number.

    `unit` is the unit that a units row or the file's own description of the column states. `clock` (n,) are the times of the
    samples [s] where the file keeps them beside the column (TDMS, MDF), otherwise None. `group` is the path of the group that
    holds the column in a file of groups (HDF5, MAT, TDMS). `aliases` are further names that the file has for it: its path, or the
    cells of other lines above the numbers.
    """

    name: str
    values: pd.Series
    unit: str | None = None
    clock: pd.Series | None = None
    group: str = ""
    aliases: tuple[str, ...] = ()

    @property
    def is_numeric(self) -> bool:
        """Whether every cell is a number or empty."""
        return bool(pd.api.types.is_numeric_dtype(self.values) and not pd.api.types.is_bool_dtype(self.values))


@dataclass(frozen=True)
class RawTable:
    """The columns of a file in their order, the sample rate [Hz] it states, and remarks about what was skipped.

    `rows` (n,) are the line numbers of the file's text or sheet, for messages; None where a file has no lines.
    """

    columns: tuple[RawColumn, ...]
    rate: float | None = None
    rows: np.ndarray | None = None
    decimal: str = "."
    remarks: tuple[str, ...] = field(default=())

    def row_text(self, index: int) -> str:
        """Where a sample stands in the file, as "row 12"; counted from the first sample where the file has no lines."""
        return f"row {int(self.rows[index])}" if self.rows is not None else f"sample {index + 1}"


def printable(text: object, longest: int = 80) -> str:
    """Text of a file without control characters, which could change a terminal, and not longer than `longest`."""
    shown = "".join(character if character.isprintable() else " " for character in str(text))
    shown = " ".join(shown.split())
    return shown if len(shown) <= longest else f"{shown[: longest - 1]}…"


def unique_names(names: Sequence[object]) -> list[str]:
    """Printable column names; an empty one becomes "column 3", a repeated one "name (2)"."""
    found: list[str] = []
    for k, name in enumerate(names, 1):
        base = printable(name, 200) or f"column {k}"
        count = 1
        while (shown := base if count == 1 else f"{base} ({count})") in found:
            count += 1
        found.append(shown)
    return found
