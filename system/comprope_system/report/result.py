"""What every function of the public interface returns: fields, a text, JSON, a table and a page."""

from __future__ import annotations

from abc import ABC, abstractmethod
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

ROWS = 12  # of the table that a notebook shows


class Result(ABC):
    """A result of `comprope_system`: its fields, and the same as text, JSON, table and HTML page."""

    @abstractmethod
    def headline(self) -> str:
        """What was found, in one sentence."""

    @abstractmethod
    def summary(self) -> str:
        """The text that the command of the same name prints, in paragraphs."""

    @abstractmethod
    def to_json(self) -> dict[str, Any]:
        """Plain dictionaries, lists, numbers and texts, as the command's `--json` writes them; what does not exist is None."""

    @abstractmethod
    def to_dataframe(self) -> pd.DataFrame:
        """The main table, one row for each thing computed."""

    @abstractmethod
    def save_html(self, path: str | Path) -> None:
        """Write a self-contained HTML page, completely or not at all; raises `InputError` if the file cannot be written."""

    def save_json(self, path: str | Path) -> None:
        """Write `to_json()` to a file, completely or not at all; raises `InputError` if it cannot be written."""
        from .json_output import save_json

        save_json(Path(path), self.to_json())

    def _repr_html_(self) -> str:
        """The headline and the first ROWS rows of the table, for notebooks."""
        table = self.to_dataframe().head(ROWS).to_html(index=False, float_format="{:.4g}".format, border=0)
        return f"<p>{escape(self.headline())}</p>\n{table}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.headline()}>"
