"""A model with an effect that was fitted: estimates, and comparisons before and after."""

from concurrent.futures import Executor
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from comprope.rope.effects import RopeModel

from ...report.json_output import plain
from ..comparison.compare import Comparison, compare
from ..estimation.coarse_to_fine import with_derivatives
from ..estimation.gauss_newton import FitResult
from ..estimation.identifiability import identifiability
from ..estimation.parameter_estimates import (
    Estimate,
    effect_estimates,
    fitted_model,
    keys_set_by_runs,
    plant_estimates,
    standard_error_scale,
)
from ..prediction.model_effects import short_names
from ..prediction.parameter_point import ParameterPoint
from ..prediction.plant_parameters import CLOCK
from .baseline_fit import BaselineFit


@dataclass(frozen=True)
class UpdatedModel:
    """A model with an effect. Comparisons: the model as given, with its plant parameters refitted, and with the effect.

    `effects` and `plant` are estimates by their keys in the model file; `already_present`: the effect was refitted, not added.
    """

    effect: str
    already_present: bool
    baseline: BaselineFit
    fitted: FitResult
    model: RopeModel
    effects: dict[str, Estimate]
    plant: dict[str, Estimate]
    before: Comparison
    refitted: Comparison
    after: Comparison

    @property
    def reduced_chi_square(self) -> float:
        """Chi-square of the fit over the number of whitened data."""
        return self.fitted.chi_square / max(len(self.baseline.problem.data), 1)

    def parameters(self) -> dict[str, Any]:
        """Fitted values by their short names; of several effects each in its own table."""
        values, names = {key: one.value for key, one in self.effects.items()}, self.effect.split(" + ")
        return short_names(names[0], values) if len(names) == 1 else {name: short_names(name, values) for name in names}

    def to_json(self) -> dict[str, Any]:
        """Errors before and after on fit and validation runs, and estimates; `misfit_per_datum` is an older name."""
        errors = {"as_it_stood": self.before, "plant_refitted": self.refitted, "with_effect": self.after}
        found = {
            "effect": self.effect, "was_in_the_model": self.already_present,
            "error_before": self.before.fit_nrmse, "error_after": self.after.fit_nrmse,
            "validate_error_before": self.before.validate_nrmse, "validate_error_after": self.after.validate_nrmse,
            "parameters": self.parameters(),
            "errors": {name: {"fit": one.fit_nrmse, "validate": one.validate_nrmse} for name, one in errors.items()},
            "runs": [
                {"file": a.file, "role": a.role, "error_before": a.nrmse, "error_after": b.nrmse}
                for a, b in zip(self.before.runs, self.after.runs, strict=True)
            ],
            "by_run": {file: dict(shifts) for file, shifts in self.fitted.point.shifts.items()},
            "intervals": {key: one.to_json() for key, one in self.effects.items()},
            "plant": {key: one.to_json() for key, one in self.plant.items()},
            "identifiability": asdict(identifiability(self.fitted, self.effects)),
            "reduced_chi_square": self.reduced_chi_square,
            "misfit_per_datum": self.reduced_chi_square,
        }  # fmt: skip
        return plain(found)


def updated_model(
    baseline: BaselineFit, effect: str, fitted: FitResult, executor: Executor, already_present: bool = False
) -> UpdatedModel:
    """The model of a fit, compared with all runs."""
    campaign, fitted = baseline.campaign, with_derivatives(baseline.problem, fitted, ParameterPoint())
    scale = standard_error_scale(fitted, len(baseline.problem.data))
    model = fitted_model(campaign, fitted)
    return UpdatedModel(
        effect, already_present, baseline, fitted, model,
        effect_estimates(fitted, scale),
        plant_estimates(campaign, fitted, scale),
        compare(campaign, executor),
        compare(replace(campaign, model=fitted_model(campaign, baseline.fitted)), executor, campaign_parameters(baseline.fitted)),
        compare(replace(campaign, model=model), executor, campaign_parameters(fitted)),
    )  # fmt: skip


def campaign_parameters(fitted: FitResult) -> ParameterPoint:
    """Estimates that belong to the campaign, not to the model: the clock offset, and phases of single runs."""
    return ParameterPoint({CLOCK: fitted.point.plant[CLOCK]}, shifts=fitted.point.shifts)


def file_comment(one: UpdatedModel) -> str:
    """The comment at the head of a model file: what was fitted, to which runs, and with which error."""
    campaign = one.before.campaign
    files = ", ".join(run.file for run in campaign.of_role("fit"))
    replaced = keys_set_by_runs(campaign)
    effects = {key: value for key, value in one.effects.items() if value.standard_error > 0.0}
    plant = {key: value for key, value in one.plant.items() if key not in replaced}
    shifts = one.fitted.point.shifts
    lines = [
        f'{campaign.model_path.name} with {one.effect}, fitted to the campaign "{campaign.name}" ({files}).',
        f"NRMSE on these runs {_percent(one.before.fit_nrmse)} before, {_percent(one.after.fit_nrmse)} after;",
        f"on validation runs {_percent(one.before.validate_nrmse)} before, {_percent(one.after.validate_nrmse)} after.",
        "Estimates with one standard error:",
        *(f"  {key} = {value.formatted()}" for key, value in effects.items()),
        *(f"  {key} = {value.formatted()} (was {value.before:.4g})" for key, value in plant.items()),
        *(f"  {key} in {file}: {shift:+.3g} from that" for file, own in shifts.items() for key, shift in own.items()),
    ]
    return "\n".join(lines)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if np.isfinite(share) else "unknown"
