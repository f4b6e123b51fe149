"""The results of `comprope_system.add` and `comprope_system.improve`: a better model."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from comprope.rope.effects import RopeModel
from comprope.rope.model_file import dump

from ...identification.comparison.compare import Comparison
from ...identification.data.campaign import Campaign
from ...identification.estimation.parameter_estimates import Estimate
from ...identification.model_updating.stepwise_selection import SelectionStep, StepwiseSelection
from ...identification.model_updating.updated_model import UpdatedModel, file_comment
from ...report.result import Result
from ..reporting import tables
from ..reporting.texts import sentences
from ..reporting.texts.estimate_sentences import estimate_sentences
from ..reporting.texts.formatting import paragraphs, text_table, wrapped


class _ModelResult(Result):
    """A result that holds a model with fitted effects."""

    updated: UpdatedModel

    @property
    def campaign(self) -> Campaign:
        """The campaign with the model as it was given."""
        return self.updated.before.campaign

    @property
    def model(self) -> RopeModel:
        """The model with its effects and plant parameters as fitted."""
        return self.updated.model

    @property
    def parameters(self) -> dict[str, Estimate]:
        """Estimates of the effects' parameters by their keys in the model file."""
        return self.updated.effects

    @property
    def plant_parameters(self) -> dict[str, Estimate]:
        """Estimates of the plant parameters by their keys in the model file."""
        return self.updated.plant

    @property
    def before(self) -> Comparison:
        """The model as given against the measurements."""
        return self.updated.before

    @property
    def after(self) -> Comparison:
        """The new model against the measurements."""
        return self.updated.after

    @property
    def reduced_chi_square(self) -> float:
        """Chi-square of the fit over the number of whitened data."""
        return self.updated.reduced_chi_square

    def save_model(self, path: str | Path) -> None:
        """Write the new model file, whose first lines say what was fitted, completely or not at all."""
        dump(self.model, path, file_comment(self.updated))

    def save_fmus(self, folder: str | Path) -> None:
        """Write CompensationRope.fmu, whose parameters start at the values of the new model, and ElevatorDrive.fmu."""
        from ...simulation.fmu_export.workflow import fmu

        fmu(self.model).save(folder)


@dataclass(frozen=True, repr=False)
class AddResult(_ModelResult):
    """A model with one effect added or refitted."""

    updated: UpdatedModel

    @property
    def effect(self) -> str:
        """The effect that was added or refitted."""
        return self.updated.effect

    def headline(self) -> str:
        """NRMSE before and after."""
        return sentences.update_sentence(self.updated)

    def summary(self) -> str:
        """NRMSE before and after, by run, and estimates with their confidence intervals."""
        stages = {"as given": self.updated.before, "plant refitted": self.updated.refitted, "with it": self.updated.after}
        errors, estimates = tables.stage_table(stages), tables.estimate_table(self.parameters)
        return paragraphs(wrapped(self.headline()), text_table(errors), text_table(estimates), *_limits(self.updated))

    def to_json(self) -> dict[str, Any]:
        """Errors before and after on fit and validation runs, and estimates."""
        return self.updated.to_json()

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each run: NRMSE of the model as given, with refitted plant parameters, and with the effect."""
        rows = [
            (one.file, one.role, one.nrmse, self.updated.refitted.runs[k].nrmse, self.updated.after.runs[k].nrmse)
            for k, one in enumerate(self.updated.before.runs)
        ]
        return pd.DataFrame(rows, columns=["file", "role", "nrmse_before", "nrmse_plant_refitted", "nrmse_after"])

    def save_html(self, path: str | Path) -> None:
        """Write a page with errors, estimates and pictures, completely or not at all."""
        from ..reporting.pages.updating import save_updated_model

        save_updated_model(Path(path), self.updated)


@dataclass(frozen=True, repr=False)
class ImproveResult(_ModelResult):
    """A model with the effects that a stepwise selection added and a backward elimination kept."""

    selection: StepwiseSelection

    @property
    def updated(self) -> UpdatedModel:  # type: ignore[override]
        """The final model with its fit and comparisons."""
        return self.selection.final

    @property
    def effects(self) -> list[str]:
        """The effects of the final model."""
        return self.selection.effects

    @property
    def removed(self) -> tuple[str, ...]:
        """Effects that were added and then removed, since the data do not require them."""
        return self.selection.removed

    @property
    def steps(self) -> tuple[SelectionStep, ...]:
        """The model after each step: NRMSE on fit and validation runs, reduced chi-square."""
        return self.selection.steps

    @property
    def verdict_kind(self) -> str:
        """The kind of the final model's diagnosis: "adequate" if the residual is explained by noise."""
        return self.selection.final_diagnosis.kind

    def headline(self) -> str:
        """Effects added, NRMSE before and after."""
        return sentences.selection_sentence(self.selection)

    def summary(self) -> str:
        """NRMSE after each step, and estimates with their confidence intervals."""
        steps, estimates = tables.step_table(self.selection), tables.estimate_table(self.parameters)
        limits = _limits(self.selection.final)
        return paragraphs(wrapped(self.headline()), text_table(steps), text_table(estimates), *limits)

    def to_json(self) -> dict[str, Any]:
        """Steps, their shares in the reduction of the NRMSE, and the final fit."""
        return self.selection.to_json()

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each step: NRMSE on fit and validation runs, reduced chi-square."""
        rows = [(one.name, one.fit_nrmse, one.validate_nrmse, one.reduced_chi_square) for one in self.steps]
        return pd.DataFrame(rows, columns=["step", "fit_nrmse", "validate_nrmse", "reduced_chi_square"])

    def save_html(self, path: str | Path) -> None:
        """Write a page with steps, estimates and pictures, completely or not at all."""
        from ..reporting.pages.updating import save_selection

        save_selection(Path(path), self.selection)


def _limits(updated: UpdatedModel) -> list[list[str]]:
    """Limits of the estimates as a paragraph, if there are any."""
    sentences_of_limits = estimate_sentences(updated.fitted, updated.effects)
    return [wrapped(*sentences_of_limits)] if sentences_of_limits else []
