"""The result of `comprope_system.new`."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from ..identification_results.result.check import CheckResult
from ..report.result import Result
from .column_roles import Role


@dataclass(frozen=True, repr=False)
class NewCampaign(Result):
    """A campaign that was written: `path` of campaign.toml, what each column was taken for, and the check of the campaign.

    `parts` are the other files of each run, with how surely and why they belong to it.
    """

    path: Path
    car: str
    columns: Mapping[str, Role]
    roles: Mapping[str, str]
    parts: Mapping[str, Mapping[str, str]]
    remarks: tuple[str, ...]
    check: CheckResult

    def headline(self) -> str:
        """How many columns are channels, and whether the campaign can be used."""
        count = sum(role.quantity is not None for role in self.columns.values())
        return f"{self.path} describes {len(self.roles)} runs with {count} channels. {self.check.headline()}"

    def summary(self) -> str:
        """What each column was taken for and how surely, the role of each run, and the check."""
        rows = self.to_dataframe()
        lines = [f"{row.column}: {row.taken_for} ({row.certainty}: {row.why})" for row in rows.itertuples(index=False)]
        runs = [f"{file}: {role}{''.join(f', with {one} ({why})' for one, why in self.parts[file].items())}"
                for file, role in self.roles.items()]  # fmt: skip
        parts = [[self.headline()], ["Columns:", *(f"  {one}" for one in lines)], ["Runs:", *(f"  {one}" for one in runs)]]
        if self.remarks:
            parts.append(["Remarks:", *(f"  {one}" for one in self.remarks)])
        parts.append([self.check.summary().rstrip()])
        if not self.check.problems:
            parts.append([f"Next: read {self.path}, then comprope compare {self.path.parent}"])
        return "\n\n".join("\n".join(lines) for lines in parts)

    def to_json(self) -> dict[str, Any]:
        """The columns with their roles, the runs, and the check."""
        columns = [
            {"column": name, "quantity": one.quantity, "sensor": one.sensor, "unit": one.unit or None, "sign": one.sign,
             "reference": one.zero if one.quantity else None, "same_as": one.same_as, "certainty": one.certainty, "why": one.why}
            for name, one in self.columns.items()
        ]  # fmt: skip
        runs = [{"file": file, "role": role, "with": dict(self.parts[file])} for file, role in self.roles.items()]
        return {
            "campaign": str(self.path), "car": self.car, "columns": columns, "runs": runs, "remarks": list(self.remarks),
            "check": self.check.to_json(),
        }  # fmt: skip

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each column: what it was taken for, how surely, and why."""
        rows = [{"column": self.car, "taken_for": "motion of the car", "certainty": "likely", "why": "by its name or its values"}]
        rows += [{"column": n, "taken_for": r.shown, "certainty": r.certainty, "why": r.why} for n, r in self.columns.items()]
        return pd.DataFrame(rows)

    def save_html(self, path: str | Path) -> None:
        """Write a page with the columns and the check, completely or not at all."""
        from ..report.page import Section, Table, save_page

        tables = (("columns", "Columns", self.to_dataframe()), ("check", "Problems and remarks", self.check.to_dataframe()))
        sections = [
            Section(key, title, [Table(list(one.columns), [list(map(str, row)) for row in one.itertuples(index=False)])])
            for key, title, one in tables
        ]
        save_page(Path(path), "New campaign", self.headline(), sections)
