"""Stepwise selection: diagnose and add until nothing is missing, then backward elimination."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from comprope.rope.effects import RopeModel

from ...report.json_output import plain
from ..comparison.compare import Comparison, compare
from ..data.campaign import Campaign
from ..diagnosis.diagnose import Diagnosis, diagnose
from ..estimation.gauss_newton import FitResult
from ..prediction.effect_hypotheses import combine
from ..prediction.model_effects import components_by_effect
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..progress import ProgressCallback, no_progress
from ..settings import MODEL_UPDATING
from .add_effect import fit_with_effect
from .backward_elimination import EffectRemoval, eliminate_backward
from .baseline_fit import BaselineFit, fit_baseline
from .updated_model import UpdatedModel, updated_model


@dataclass(frozen=True)
class SelectionStep:
    """The model after a step: what was added last, its NRMSE on fit and validation runs, and its reduced chi-square."""

    name: str
    fit_nrmse: float
    validate_nrmse: float
    reduced_chi_square: float


@dataclass(frozen=True)
class StepwiseSelection:
    """All steps and diagnoses, the effects removed at the end, fits without each remaining effect, and the final model."""

    steps: tuple[SelectionStep, ...]
    diagnoses: tuple[Diagnosis, ...]
    removed: tuple[str, ...]
    removals: tuple[EffectRemoval, ...]
    final: UpdatedModel

    @property
    def final_diagnosis(self) -> Diagnosis:
        """The diagnosis of the final model."""
        return self.diagnoses[-1]

    @property
    def model(self) -> RopeModel:
        """The final model."""
        return self.final.model

    @property
    def effects(self) -> list[str]:
        """The effects of the final model."""
        return list(components_by_effect(self.final.fitted.hypothesis, self.final.fitted.effect_coefficients))

    def error_reductions(self) -> list[tuple[str, float, float]]:
        """The share of each step in the whole reduction of the NRMSE, on fit and on validation runs."""
        first, last = self.steps[0], self.steps[-1]
        fit, validate = first.fit_nrmse - last.fit_nrmse, first.validate_nrmse - last.validate_nrmse
        return [
            (b.name, _share(a.fit_nrmse - b.fit_nrmse, fit), _share(a.validate_nrmse - b.validate_nrmse, validate))
            for a, b in pairwise(self.steps)
        ]

    def to_json(self) -> dict[str, Any]:
        """Steps, shares and the final fit; `bought`, `pruned` and `misfit_per_datum` are older names kept beside the new ones."""
        shares = [{"name": name, "share": fit, "validate_share": held} for name, fit, held in self.error_reductions()]
        found = {
            "verdict_kind": self.final_diagnosis.kind,
            "effects": self.effects,
            "steps": [
                {
                    "name": s.name, "fit": s.fit_nrmse, "validate": s.validate_nrmse,
                    "reduced_chi_square": s.reduced_chi_square, "misfit_per_datum": s.reduced_chi_square,
                }
                for s in self.steps
            ],
            "error_reductions": shares, "bought": shares,
            "removed": list(self.removed), "pruned": list(self.removed),
            "without": {one.effect: one.reduced_chi_square for one in self.removals},
            **self.final.to_json(),
        }  # fmt: skip
        return plain(found)


def _share(part: float, whole: float) -> float:
    return part / whole if whole else float("nan")


def select_stepwise(
    campaign: Campaign,
    executor: Executor,
    report_progress: ProgressCallback = no_progress,
    max_effects: int = MODEL_UPDATING.max_effects,
) -> StepwiseSelection:
    """Add the effect of one diagnosis after the other until the model is adequate or no known effect helps."""
    baseline = fit_baseline(campaign, executor, report_progress)
    before = compare(campaign, executor)
    steps = [SelectionStep("as it stands", before.fit_nrmse, before.validate_nrmse, float("nan"))]
    fitted: FitResult = baseline.fitted
    steps.append(_step(baseline, "plant refitted", fitted, executor))
    found: list[Diagnosis] = []
    while True:
        found.append(diagnose(campaign, executor, report_progress, fitted.point))
        if found[-1].verdict is None or len(steps) > max_effects + 1:
            break
        for name, step in _add_each(baseline, found[-1], fitted, report_progress):
            fitted = step
            steps.append(_step(baseline, name, fitted, executor))
    names = set(components_by_effect(fitted.hypothesis, fitted.effect_coefficients))
    fitted, removals = eliminate_backward(baseline, fitted, report_progress)
    kept = list(components_by_effect(fitted.hypothesis, fitted.effect_coefficients))
    whole = updated_model(baseline, " + ".join(kept) or "nothing", fitted, executor)
    return StepwiseSelection(tuple(steps), tuple(found), tuple(sorted(names - set(kept))), tuple(removals), whole)


def _step(baseline: BaselineFit, name: str, fitted: FitResult, executor: Executor) -> SelectionStep:
    found: Comparison = compare(baseline.campaign, executor, fitted.point, fitted.predictions)
    return SelectionStep(name, found.fit_nrmse, found.validate_nrmse, fitted.chi_square / max(len(baseline.problem.data), 1))


def _add_each(
    baseline: BaselineFit, found: Diagnosis, fitted: FitResult, report_progress: ProgressCallback
) -> Iterator[tuple[str, FitResult]]:
    """Fits with the effects of a verdict added one after the other, so that each shows its share in the reduction."""
    best = found.ranking[0].fitted
    plant = best.coefficients[: len(PLANT_PARAMETERS)]
    components = components_by_effect(best.hypothesis, best.effect_coefficients)
    for name, parts in components.items():
        report_progress(f"fitting {name} with all other effects")
        start = np.concatenate([plant, *(own for _, own in parts)])
        new = combine(*(part for part, _ in parts))
        fitted = fit_with_effect(baseline, new, start, fitted, search=len(components) > 1)
        yield name, fitted
