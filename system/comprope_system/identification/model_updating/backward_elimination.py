"""Which effects of a model could go without its error rising."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..estimation.gauss_newton import Fitted, refine
from ..estimation.model_score import PRICE, score
from ..hypotheses.model_effects import grouped, joined
from ..hypotheses.plant_parameters import NUISANCES
from ..prediction.parameter_point import Point
from .add_effect import Ground, Say

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Without:
    """A fit without one of the effects; `could_go`: the data do not miss it."""

    effect: str
    fitted: Fitted
    could_go: bool


def without_each(ground: Ground, fitted: Fitted, say: Say = lambda _: None) -> list[Without]:
    """The fit repeated without each of its effects in turn."""
    names = list(grouped(fitted.hypothesis, fitted.effect_coefficients))
    return [_without(ground, fitted, name, say) for name in names]


def prune(ground: Ground, fitted: Fitted, say: Say = lambda _: None) -> tuple[Fitted, list[Without]]:
    """The fit without effects that the data do not miss, taken out one at a time, least missed first; and the last looks."""
    looks = without_each(ground, fitted, say)
    idle = [one for one in looks if one.could_go]
    if not idle:
        return fitted, looks
    return prune(ground, min(idle, key=lambda one: one.fitted.misfit).fitted, say)


def _without(ground: Ground, fitted: Fitted, name: str, say: Say) -> Without:
    say(f"without {name}")
    groups = grouped(fitted.hypothesis, fitted.effect_coefficients)
    kept = [pair for effect, pairs in groups.items() if effect != name for pair in pairs]
    left = joined([part for part, _ in kept])
    start = np.concatenate([fitted.coefficients[: len(NUISANCES)], [c for _, own in kept for c in own]])
    found = refine(ground.problem, left, start, Point())
    return Without(name, found, _score(ground, found) >= _score(ground, fitted))


def _score(ground: Ground, fitted: Fitted) -> float:
    """The diagnosis' own score: what the effects explain, less what they cost."""
    groups = grouped(fitted.hypothesis, fitted.effect_coefficients)
    price = sum(PRICE * (1 + sum(len(part.directions) for part, _ in pairs)) for pairs in groups.values())
    return score(fitted.misfit, len(ground.problem.data), price + fitted.strain)
