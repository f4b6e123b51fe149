"""The result of `comprope_system.check`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from ...identification.data.campaign_check import CampaignCheck, RunCheck
from ...report.result import Result
from ..reporting.texts.formatting import paragraphs, wrapped


@dataclass(frozen=True, repr=False)
class CheckResult(Result):
    """What reading a campaign found, without a simulation: problems, with which it is not used, and remarks."""

    found: CampaignCheck

    @property
    def runs(self) -> tuple[RunCheck, ...]:
        """Each run with its file, problems and remarks."""
        return self.found.runs

    @property
    def problems(self) -> tuple[str, ...]:
        """All problems: those of campaign.toml and the model file, then those of each run."""
        return (*self.found.problems, *(one for run in self.runs for one in run.problems))

    @property
    def remarks(self) -> tuple[str, ...]:
        """All remarks, each with the file of its run."""
        return tuple(f"{run.file}: {one}" for run in self.runs for one in run.remarks)

    def headline(self) -> str:
        """Whether the campaign can be used."""
        count = len(self.problems)
        if count:
            return f"{self.found.name}: {count} {'problem' if count == 1 else 'problems'}; the campaign cannot be used as it is"
        said = f"{len(self.remarks)} {'remark' if len(self.remarks) == 1 else 'remarks'}" if self.remarks else "no remarks"
        return f"{self.found.name}: {len(self.runs)} {'run' if len(self.runs) == 1 else 'runs'} can be used, {said}"

    def summary(self) -> str:
        """The headline, and each problem and remark by file."""
        parts = [wrapped(self.headline()), list(self.found.problems)]
        for run in self.runs:
            lines = [*(f"  problem: {one}" for one in run.problems), *(f"  remark: {one}" for one in run.remarks)]
            parts.append([run.file, *(lines or ["  nothing to remark"])])
        return paragraphs(*parts)

    def to_json(self) -> dict[str, Any]:
        """Problems and remarks by run, and the problems of campaign.toml and the model file."""
        runs = [{"file": run.file, "problems": list(run.problems), "remarks": list(run.remarks)} for run in self.runs]
        return {"campaign": self.found.name, "problems": list(self.found.problems), "runs": runs}

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each problem and remark."""
        rows = [{"file": "campaign.toml", "kind": "problem", "sentence": one} for one in self.found.problems]
        for run in self.runs:
            rows += [{"file": run.file, "kind": "problem", "sentence": one} for one in run.problems]
            rows += [{"file": run.file, "kind": "remark", "sentence": one} for one in run.remarks]
        return pd.DataFrame(rows, columns=["file", "kind", "sentence"])

    def save_html(self, path: str | Path) -> None:
        """Write a page with a table of problems and remarks, completely or not at all."""
        from ..reporting.pages.check import save_check

        save_check(Path(path), self.headline(), self.to_dataframe())
