"""Backward elimination: effects whose removal the data do not contradict are taken out of a model."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..estimation.gauss_newton import FitResult
from ..estimation.model_score import NoiseLevel, log_score
from ..prediction.model_effects import combined_or_none, components_by_effect
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..progress import ProgressCallback, no_progress
from ..settings import SCORE
from .baseline_fit import BaselineFit

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class EffectRemoval:
    """The fit without one of the effects; it is `removable` if the score does not fall without it."""

    effect: str
    fitted: FitResult
    reduced_chi_square: float
    removable: bool


def remove_each(
    baseline: BaselineFit, fitted: FitResult, report_progress: ProgressCallback = no_progress
) -> list[EffectRemoval]:
    """The fit repeated without each of its effects in turn."""
    names = list(components_by_effect(fitted.hypothesis, fitted.effect_coefficients))
    return [_remove(baseline, fitted, name, report_progress) for name in names]


def eliminate_backward(
    baseline: BaselineFit, fitted: FitResult, report_progress: ProgressCallback = no_progress
) -> tuple[FitResult, list[EffectRemoval]]:
    """The fit without removable effects, taken out one at a time, least chi-square first; and the fits without each other one."""
    removals = remove_each(baseline, fitted, report_progress)
    removable = [one for one in removals if one.removable]
    if not removable:
        return fitted, removals
    return eliminate_backward(baseline, min(removable, key=lambda one: one.fitted.chi_square).fitted, report_progress)


def _remove(baseline: BaselineFit, fitted: FitResult, name: str, report_progress: ProgressCallback) -> EffectRemoval:
    report_progress(f"without {name}")
    groups = components_by_effect(fitted.hypothesis, fitted.effect_coefficients)
    kept = [pair for effect, pairs in groups.items() if effect != name for pair in pairs]
    left = combined_or_none([part for part, _ in kept])
    start = np.concatenate([fitted.coefficients[: len(PLANT_PARAMETERS)], [c for _, own in kept for c in own]])
    # Without any effect it is the fit that the selection has begun with.
    found = baseline.fitted if left is baseline.fitted.hypothesis else baseline.fit(left, start)
    noise = NoiseLevel.of_fits(len(baseline.problem.data), (found.chi_square, fitted.chi_square))
    return EffectRemoval(name, found, found.chi_square / noise.count, _score(found, noise) >= _score(fitted, noise))


def _score(fitted: FitResult, noise: NoiseLevel) -> float:
    """The diagnosis' own score: what the effects explain, less what they cost."""
    groups = components_by_effect(fitted.hypothesis, fitted.effect_coefficients)
    complexity_penalty = sum(
        SCORE.parameter_penalty * (1 + sum(len(part.directions) for part, _ in pairs)) for pairs in groups.values()
    )
    return log_score(fitted.chi_square, noise, complexity_penalty + fitted.prior_cost)
