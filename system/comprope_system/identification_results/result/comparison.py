"""The result of `comprope_system.compare`."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from ...identification.comparison.compare import Comparison, RunComparison
from ...identification.comparison.largest_error import LargestError, largest_error
from ...identification.data.campaign import Campaign
from ...identification.preview.effect_preview import EffectPreview
from ...report.json_output import plain
from ...report.result import Result
from ..reporting import tables
from ..reporting.texts import sentences
from ..reporting.texts.formatting import listed, paragraphs, text_table, wrapped


@dataclass(frozen=True, repr=False)
class ComparisonResult(Result):
    """The model against the measurements of a campaign: `comparison` with all series, `remarks` on the quality of the data.

    `previews` are those of the effects that the model has, if they were asked for; `variants` are further models by their names.
    """

    comparison: Comparison
    remarks: tuple[str, ...]
    previews: tuple[EffectPreview, ...] = ()
    variants: Mapping[str, Comparison] = field(default_factory=dict)

    @property
    def campaign(self) -> Campaign:
        """The campaign with its model and runs."""
        return self.comparison.campaign

    @property
    def runs(self) -> tuple[RunComparison, ...]:
        """Each run with its channels: series, errors by phase, car position and frequency."""
        return self.comparison.runs

    @property
    def nrmse(self) -> float:
        """RMS error over the standard deviation of the measured channel, root mean square over all channels and runs."""
        return self.comparison.nrmse

    @property
    def fit_nrmse(self) -> float:
        """The NRMSE of the fit runs."""
        return self.comparison.fit_nrmse

    @property
    def validate_nrmse(self) -> float:
        """The NRMSE of the validation runs, NaN if there are none."""
        return self.comparison.validate_nrmse

    @property
    def reduced_chi_square(self) -> float:
        """Mean square of the residual over the variance of the noise, mean over channels and runs."""
        return self.comparison.reduced_chi_square

    @property
    def largest_error(self) -> LargestError | None:
        """Run, channel and phase of the trip with the largest error; None where noise explains all."""
        return largest_error(self.comparison)

    @property
    def models(self) -> dict[str, Comparison]:
        """The campaign's model, called "model", and the variants."""
        return {"model": self.comparison, **self.variants}

    def headline(self) -> str:
        """NRMSE on fit and validation runs."""
        return sentences.comparison_sentences(self.comparison)[0]

    def summary(self) -> str:
        """Where the model fails most, NRMSE, reduced chi-square, errors by run, channel and phase, remarks on the data."""
        return paragraphs(
            wrapped(sentences.largest_error_sentence(self.comparison)),
            wrapped(*sentences.comparison_sentences(self.comparison)),
            text_table(tables.error_table(self.comparison)),
            text_table(tables.stage_table(self.models)) if self.variants else [],
            listed("Data quality:", self.remarks),
        )

    def to_json(self) -> dict[str, Any]:
        """Errors of all runs and channels in the unit of the channel; `largest_error` is null if noise explains all.

        `variants` have the NRMSE of each further model.
        """
        worst = self.largest_error
        found: dict[str, Any] = {"remarks": list(self.remarks), "largest_error": plain(worst.to_json()) if worst else None}
        found["variants"] = [
            plain({"model": name, "fit_nrmse": one.fit_nrmse, "validate_nrmse": one.validate_nrmse})
            for name, one in self.variants.items()
        ]
        return self.comparison.to_json() | found

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each run and channel: NRMSE, RMS error in the unit of the channel, reduced chi-square, NRMSE by phase."""
        rows = [
            {
                "file": run.file, "role": run.role, "channel": one.column, "unit": one.channel.unit, "nrmse": one.nrmse,
                "rmse": one.rmse / one.channel.scale, "reduced_chi_square": one.reduced_chi_square, **one.by_phase,
            }
            for run in self.runs
            for one in run.channels
        ]  # fmt: skip
        return pd.DataFrame(rows)

    def save_html(self, path: str | Path) -> None:
        """Write a page with a table of errors and the curves of every run, completely or not at all."""
        from ..reporting.pages.comparison import save_comparison

        save_comparison(Path(path), self.comparison, self.remarks, self.previews, self.variants)
