"""From a model that fails to one that does not: diagnose, add, and again, until nothing is missing; then prune."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from comprope.rope.effects import RopeModel

from ...report.json_output import plain
from ..comparison.compare import Comparison, compare
from ..data.campaign import Campaign
from ..diagnosis.diagnose import Diagnosis, diagnose
from ..estimation.gauss_newton import FitResult
from ..hypotheses.effect_hypotheses import combine
from ..hypotheses.model_effects import components_by_effect
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..progress import ProgressCallback, no_progress
from ..settings import MODEL_UPDATING
from .add_effect import Added, Ground, added, fit_new, prepare
from .backward_elimination import Without, prune


@dataclass(frozen=True)
class Step:
    """A stop on the way: what was added last, errors on fit and validate runs there, and the misfit per datum."""

    name: str
    fit: float
    validate: float
    reduced_chi_square: float


@dataclass(frozen=True)
class Journey:
    """All stops and diagnoses, what pruning took out, fits without each effect, and the final model."""

    steps: tuple[Step, ...]
    diagnoses: tuple[Diagnosis, ...]
    pruned: tuple[str, ...]
    without: tuple[Without, ...]
    added: Added

    @property
    def last(self) -> Diagnosis:
        """What is to be said of the final model."""
        return self.diagnoses[-1]

    @property
    def model(self) -> RopeModel:
        """The final model."""
        return self.added.model

    def bought(self) -> list[tuple[str, float, float]]:
        """What each step bought: its share of the whole fall of the error, on fit and on validate runs."""
        first, last = self.steps[0], self.steps[-1]
        return [
            (b.name, _share(a.fit - b.fit, first.fit - last.fit), _share(a.validate - b.validate, first.validate - last.validate))
            for a, b in zip(self.steps[:-1], self.steps[1:], strict=True)
        ]

    def to_json(self) -> dict[str, Any]:
        """Steps, shares and the final fit."""
        found = {
            "verdict_kind": self.last.kind,
            "effects": list(components_by_effect(self.added.fitted.hypothesis, self.added.fitted.effect_coefficients)),
            "steps": [
                {"name": s.name, "fit": s.fit, "validate": s.validate, "misfit_per_datum": s.reduced_chi_square}
                for s in self.steps
            ],
            "bought": [{"name": name, "share": fit, "validate_share": held} for name, fit, held in self.bought()],
            "pruned": list(self.pruned),
            "without": {one.effect: one.fitted.chi_square / max(len(self.last.problem.data), 1) for one in self.without},
            **self.added.to_json(),
        }  # fmt: skip
        return plain(found)


def _share(fall: float, whole: float) -> float:
    return fall / whole if whole else float("nan")


def journey(
    campaign: Campaign,
    executor: Executor,
    report_progress: ProgressCallback = no_progress,
    most: int = MODEL_UPDATING.max_effects,
) -> Journey:
    """Add what is missing, one verdict after the other, until the model is adequate or nothing known helps."""
    ground = prepare(campaign, executor, report_progress)
    before = compare(campaign, executor)
    steps = [Step("as it stands", before.fit_nrmse, before.validate_nrmse, float("nan"))]
    fitted: FitResult = ground.fitted
    steps.append(_step(ground, "plant refitted", fitted, executor))
    found: list[Diagnosis] = []
    while True:
        found.append(diagnose(campaign, executor, report_progress, replace(fitted.point, plant={})))
        if found[-1].verdict is None or len(steps) > most + 1:
            break
        for name, step in _each(ground, found[-1], fitted, report_progress):
            fitted = step
            steps.append(_step(ground, name, fitted, executor))
    names = set(components_by_effect(fitted.hypothesis, fitted.effect_coefficients))
    fitted, without = prune(ground, fitted, report_progress)
    kept = list(components_by_effect(fitted.hypothesis, fitted.effect_coefficients))
    whole = added(ground, " + ".join(kept) or "nothing", fitted, executor)
    return Journey(tuple(steps), tuple(found), tuple(sorted(names - set(kept))), tuple(without), whole)


def _step(ground: Ground, name: str, fitted: FitResult, executor: Executor) -> Step:
    found: Comparison = compare(ground.campaign, executor, fitted.point, fitted.predictions)
    return Step(name, found.fit_nrmse, found.validate_nrmse, fitted.chi_square / max(len(ground.problem.data), 1))


def _each(
    ground: Ground, found: Diagnosis, fitted: FitResult, report_progress: ProgressCallback
) -> Iterator[tuple[str, FitResult]]:
    """The verdict's effects added one after the other, so that each shows what it buys."""
    best = found.ranking[0].fitted
    plant = best.coefficients[: len(PLANT_PARAMETERS)]
    for name, parts in components_by_effect(best.hypothesis, best.effect_coefficients).items():
        report_progress(f"{name}, with all others")
        start = np.concatenate([plant, *(own for _, own in parts)])
        fitted = fit_new(ground, combine(*(part for part, _ in parts)), start, fitted)
        yield name, fitted
