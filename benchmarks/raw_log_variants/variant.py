"""A file as another logger would have written it, and how such files are made."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

START = datetime(2026, 11, 2, 9, 12, 1, 123000)  # of the record
Write = Callable[[Path], None]


@dataclass(frozen=True)
class Variant:
    """A file to write, its name, and what campaign.toml states about it (`extra`), also in the run (`run_extra`)."""

    name: str
    file: str
    write: Write
    extra: str = ""
    run_extra: str = ""
    asked: str = ""  # the channel of which campaign.toml leaves out samples
    truth: pd.DataFrame | None = None  # what the file says, where that is not the plain table
    motion: NDArray[np.float64] | None = None  # true positions (n,) of the car [m] behind a noisy signal


def csv(table: pd.DataFrame, **options: object) -> str:
    """The table as text."""
    return table.to_csv(index=False, **options)  # type: ignore[call-overload,no-any-return]


def text(name: str, content: str | bytes, extra: str = "", run_extra: str = "", file: str = "run.csv") -> Variant:
    """A variant with this content."""
    data = content.encode("utf-8") if isinstance(content, str) else content
    return Variant(name, file, lambda path: write_bytes(path, data), extra, run_extra)


def other(name: str, table: pd.DataFrame) -> Variant:
    """A variant of a table that differs from the plain one, as the file says."""
    return replace(text(name, csv(table)), truth=table)


def write_bytes(path: Path, data: bytes) -> None:
    """Write a file."""
    path.write_bytes(data)


def inserted(table: pd.DataFrame, at: int, name: str, values: object, allow_duplicates: bool = False) -> pd.DataFrame:
    """The table with a further column."""
    found = table.copy()
    found.insert(at, name, values, allow_duplicates=allow_duplicates)
    return found
