"""The result of `comprope_system.diagnose`."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from comprope.atomic_files import atomic_write
from comprope.errors import InputError

from ...identification.data.campaign import Campaign
from ...identification.diagnosis.experiment_design import ProposedRun
from ...identification.diagnosis.held_out_validation import ValidatedDiagnosis, plant, ranking, to_json
from ...identification.estimation.parameter_estimates import Estimate
from ...identification.preview.effect_preview import EffectPreview
from ...identification.residuals.effect_skeleton import effect_skeleton
from ...identification.residuals.input_estimation import InputEstimation
from ...identification.residuals.residual_correlation import ResidualCorrelation, correlation_sentences
from ...report.json_output import plain
from ...report.result import Result
from ..reporting import tables
from ..reporting.pages.verdict_card import next_command
from ..reporting.texts import sentences
from ..reporting.texts.formatting import listed, paragraphs, text_table, wrapped

RUNS = 5  # proposed runs in JSON


@dataclass(frozen=True, repr=False)
class DiagnosisResult(Result):
    """Which effect is missing from the model of a campaign.

    `validated` has the fits and their comparisons with all runs. `correlations` say what the residual of the refitted model
    correlates with, `rest_ratio` is its RMS at rest over that of the whole, `residual_force` the force that would explain it,
    estimated for an unknown effect only. `next_runs` are runs to measure, the most discriminating first, if one more is needed.
    `previews` are those of the best fit and its rivals, if they were asked for.
    """

    validated: ValidatedDiagnosis
    correlations: tuple[ResidualCorrelation, ...]
    rest_ratio: float
    residual_force: InputEstimation | None
    next_runs: tuple[ProposedRun, ...]
    previews: tuple[EffectPreview, ...] = ()

    @property
    def campaign(self) -> Campaign:
        """The campaign with its model and runs."""
        return self.validated.diagnosis.campaign

    @property
    def verdict(self) -> str | None:
        """The missing effect, None if the model is adequate or no known effect explains the residual."""
        return self.validated.diagnosis.verdict

    @property
    def verdict_kind(self) -> str:
        """One of "known_effect", "instrument", "unknown_effect", "adequate"."""
        return self.validated.diagnosis.kind

    @property
    def probabilities(self) -> dict[str, float]:
        """The probability of each effect, of "adequate" and of "unknown"; their sum is 1."""
        return self.validated.diagnosis.probabilities

    @property
    def ranking(self) -> list[dict[str, Any]]:
        """An entry for each effect as in JSON, most probable first: errors before and after, parameters, reduced chi-square."""
        return ranking(self.validated)

    @property
    def indistinguishable(self) -> tuple[tuple[str, str], ...]:
        """Pairs of effects whose responses in these runs are nearly the same."""
        return self.validated.diagnosis.indistinguishable

    @property
    def plant_parameters(self) -> dict[str, Estimate]:
        """Plant parameters as fitted with the verdict's effect, or alone, by their keys in the model file."""
        return plant(self.validated.diagnosis)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks on the quality of the data."""
        return self.validated.remarks

    @cached_property
    def effect_skeleton(self) -> str | None:
        """The file of an effect with the estimated force; None where no effect is unknown, or the force follows nothing."""
        return effect_skeleton(self.residual_force, self.campaign) if self.residual_force else None

    def save_skeleton(self, path: str | Path) -> None:
        """Write `effect_skeleton` to a file, completely or not at all; raises `InputError` where there is none."""
        if (text := self.effect_skeleton) is None:
            raise InputError(f"{path}: not written: only an unknown effect whose force follows the motion has a skeleton")
        with atomic_write(path) as temporary:
            temporary.write_text(text, encoding="utf-8")

    def headline(self) -> str:
        """The verdict with its probability."""
        return sentences.verdict_sentences(self.validated)[0]

    def summary(self) -> str:
        """Verdict, ranking, remarks on the data, and what to do next."""
        force = self.residual_force
        forces = [*wrapped(f"{force.sentence()}."), *text_table(tables.force_table(force, tables.SHOWN))] if force else []
        unknown = self.verdict_kind == "unknown_effect"
        correlations = correlation_sentences(list(self.correlations), self.rest_ratio) if unknown else []
        return paragraphs(
            wrapped(*sentences.verdict_sentences(self.validated)),
            text_table(tables.ranking_table(self.validated, tables.SHOWN)),
            listed("Data quality:", self.remarks),
            listed("Residual:", correlations),
            forces,
            [f"Next run to measure: {self.next_runs[0].sentence()}."] if self.next_runs else [],
            self._next_command(),
        )

    def _next_command(self) -> list[str]:
        command = next_command(self.validated)
        return [f"Next command: {command}"] if command else []

    def to_json(self) -> dict[str, Any]:
        """Verdict, ranking, plant parameters, correlations (`clues` is their older name), proposed runs, estimated force."""
        correlations = [{"coordinate": one.coordinate, "share": one.share, "peak": one.peak} for one in self.correlations]
        found = to_json(self.validated) | {
            "residual_correlations": correlations, "clues": correlations,
            "next_runs": [one.to_json() for one in self.next_runs[:RUNS]],
        }  # fmt: skip
        if self.residual_force:
            found |= {"residual_force": self.residual_force.to_json(), "effect_skeleton": self.effect_skeleton}
        return plain(found)

    def to_dataframe(self) -> pd.DataFrame:
        """The ranking, one row for each effect: probability, NRMSE before and after, reduced chi-square, parameters as text."""
        rows = [
            {
                "effect": tables.effect_names(one), "probability": one["probability"],
                "nrmse_before": one["error_before"], "nrmse_after": one["error_after"],
                "validate_nrmse_before": one["validate_error_before"], "validate_nrmse_after": one["validate_error_after"],
                "reduced_chi_square": one["reduced_chi_square"], "parameters": tables.parameters(one),
            }
            for one in self.ranking
        ]  # fmt: skip
        return pd.DataFrame(rows)

    def save_html(self, path: str | Path) -> None:
        """Write a page with verdict, ranking and pictures, completely or not at all."""
        from ..reporting.pages.diagnosis import save_diagnosis

        save_diagnosis(
            Path(path), self.validated, self.correlations, self.rest_ratio, self.residual_force, self.next_runs,
            self.previews,
        )  # fmt: skip
