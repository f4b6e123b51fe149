"""Which effects of a model could go without its error rising."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..estimation.gauss_newton import FitResult, gauss_newton
from ..estimation.model_score import log_score
from ..hypotheses.model_effects import combined_or_none, components_by_effect
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint
from ..progress import ProgressCallback, no_progress
from ..settings import SCORE
from .add_effect import Ground

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Without:
    """A fit without one of the effects; `could_go`: the data do not miss it."""

    effect: str
    fitted: FitResult
    could_go: bool


def without_each(ground: Ground, fitted: FitResult, report_progress: ProgressCallback = no_progress) -> list[Without]:
    """The fit repeated without each of its effects in turn."""
    names = list(components_by_effect(fitted.hypothesis, fitted.effect_coefficients))
    return [_without(ground, fitted, name, report_progress) for name in names]


def prune(ground: Ground, fitted: FitResult, report_progress: ProgressCallback = no_progress) -> tuple[FitResult, list[Without]]:
    """The fit without effects that the data do not miss, taken out one at a time, least missed first; and the last looks."""
    looks = without_each(ground, fitted, report_progress)
    idle = [one for one in looks if one.could_go]
    if not idle:
        return fitted, looks
    return prune(ground, min(idle, key=lambda one: one.fitted.chi_square).fitted, report_progress)


def _without(ground: Ground, fitted: FitResult, name: str, report_progress: ProgressCallback) -> Without:
    report_progress(f"without {name}")
    groups = components_by_effect(fitted.hypothesis, fitted.effect_coefficients)
    kept = [pair for effect, pairs in groups.items() if effect != name for pair in pairs]
    left = combined_or_none([part for part, _ in kept])
    start = np.concatenate([fitted.coefficients[: len(PLANT_PARAMETERS)], [c for _, own in kept for c in own]])
    found = gauss_newton(ground.problem, left, start, ParameterPoint())
    return Without(name, found, _score(ground, found) >= _score(ground, fitted))


def _score(ground: Ground, fitted: FitResult) -> float:
    """The diagnosis' own score: what the effects explain, less what they cost."""
    groups = components_by_effect(fitted.hypothesis, fitted.effect_coefficients)
    complexity_penalty = sum(
        SCORE.parameter_penalty * (1 + sum(len(part.directions) for part, _ in pairs)) for pairs in groups.values()
    )
    return log_score(fitted.chi_square, len(ground.problem.data), complexity_penalty + fitted.prior_cost)
