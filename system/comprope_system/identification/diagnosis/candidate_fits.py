"""Every effect as a rival for what the data show: fitted on the full model where that is worth its time, else by its linear look.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from comprope.errors import SimulationError

from ..estimation.gauss_newton import Fitted, refine
from ..estimation.initial_guess import best_start
from ..estimation.mass_search import LEFT, brought_into_step
from ..estimation.model_score import price, score
from ..estimation.weighted_least_squares import Problem
from ..hypotheses.effect_hypotheses import Hypothesis, together
from ..hypotheses.model_effects import shapes_of
from ..hypotheses.plant_parameters import NUISANCES
from ..prediction.parameter_point import Point
from .linear_screening import Screened, alike, screen

Say = Callable[[str], None]
REFINED = 4  # hypotheses that are refined on the full model, if no other one leads
RIVAL = 1.2  # times the best fit's misfit above which a fit is not worth its time
PROMISING = 0.1  # of what the best linear look explains: the least that is worth a fit
NOTICED = 0.01  # of misfit per datum: less than that is no reason for a fit
SECOND = 0.85  # of the misfit that the best effect may leave if a second one is to be looked for
CHALLENGERS = 2  # effects seen from elsewhere that are refined
PROMISED = 0.7  # of the best fit's misfit: what they must promise
PAIRS = 2  # second effects that are refined with the first
NEAR = 1.15  # times the best fit's misfit: near enough to it
WORTH = 0.97  # of its misfit that it must fall to


class Trial(NamedTuple):
    """An effect's linear look, its fit, and whether that is one on the full model."""

    seen: Screened
    fitted: Fitted
    refined: bool

    @property
    def hypothesis(self) -> Hypothesis:
        """What is fitted."""
        assert self.fitted.hypothesis is not None
        return self.fitted.hypothesis

    def score(self, count: int) -> float:
        """Score of the fit to `count` data."""
        return score(self.fitted.misfit, count, price(self.hypothesis, self.seen.alternatives) + self.fitted.strain)


def rivals(problem: Problem, origin: Point, screened: list[Screened], none: Fitted, say: Say) -> list[Trial]:
    """Every effect fitted: the promising ones on the full model, the others as the linear look has them.

    A linear look alone does not win: whichever leads is fitted as well, until what leads is a fit.
    """
    worth = NOTICED * len(problem.data)
    found = [_by_look(one, none) for one in screened]
    least = max(PROMISING * (none.strained - found[0].fitted.strained), worth)
    for k, one in enumerate(screened[:REFINED]):
        if none.strained - found[k].fitted.strained > least and _may_win(found[k], none, found):
            found[k] = _on_full_model(problem, origin, one, none, found, say)
    leader = _leader(found, len(problem.data))
    while not found[leader].refined and found[leader].fitted.strained < none.strained - worth:
        found[leader] = _on_full_model(problem, origin, screened[leader], none, found, say)
        leader = _leader(found, len(problem.data))
    if found[leader].refined:
        found[leader] = _finished(problem, origin, found[leader])
        _twins_fitted(problem, origin, screened, none, found, leader, say)
    return found


def _twins_fitted(
    problem: Problem, origin: Point, screened: Sequence[Screened], none: Fitted, found: list[Trial], leader: int, say: Say
) -> None:
    """Fit what looks like the leader as well: of two effects with much the same trace a linear look may have misjudged one."""
    for k, one in enumerate(screened):
        if not found[k].refined and alike(one, screened[leader]):
            found[k] = _on_full_model(problem, origin, one, none, found, say)


def challenged(
    problem: Problem, origin: Point, screened: Sequence[Screened], none: Fitted, found: Sequence[Trial], say: Say
) -> list[Trial]:
    """The trials, or better ones of the same effects that begin where `screened` saw them."""
    trials = {one.hypothesis.effect: one for one in found}
    for one in screened[:CHALLENGERS]:
        if one.misfit < PROMISED * least_misfit(trials.values(), none):
            trial = _finished(problem, origin, _on_full_model(problem, origin, one, none, list(trials.values()), say))
            known = trials.setdefault(one.hypothesis.effect, trial)
            trials[one.hypothesis.effect] = min(known, trial, key=lambda own: own.fitted.misfit)
    return list(trials.values())


def _finished(problem: Problem, origin: Point, one: Trial) -> Trial:
    """The trial with another mass, if that brings it into step, and what shapes its effects free there."""
    moved = brought_into_step(problem, one.fitted, origin)
    return one if moved is one.fitted else one._replace(fitted=shaped(problem, origin, moved))


def least_misfit(found: Iterable[Trial], none: Fitted) -> float:
    """Misfit of the best fit."""
    return min((one.fitted.misfit for one in found if one.refined), default=none.misfit)


def _may_win(one: Trial, none: Fitted, found: Sequence[Trial]) -> bool:
    """Whether an effect that explains half as much again as its linear look has it would come near the best fit so far."""
    at_best = one.fitted.strained - 0.5 * (none.strained - one.fitted.strained)
    return at_best < NEAR * min((trial.fitted.strained for trial in found if trial.refined), default=none.strained)


def _leader(found: Sequence[Trial], count: int) -> int:
    return max(range(len(found)), key=lambda k: found[k].score(count))


def _by_look(one: Screened, none: Fitted) -> Trial:
    """The fit that a linear look promises."""
    fitted = replace(none, hypothesis=one.hypothesis, coefficients=one.start, misfit=one.misfit, strain=one.strain)
    return Trial(one, fitted, False)


def _on_full_model(
    problem: Problem, origin: Point, one: Screened, none: Fitted, found: Sequence[Trial], say: Say
) -> Trial:
    """The effect fitted; one that cannot be simulated explains nothing. A fit ends early once it cannot come near the best."""
    say(f"{one.hypothesis.effect}, on the full model")
    rival = RIVAL * min((trial.fitted.misfit for trial in found if trial.refined), default=float("inf"))
    try:
        start = best_start(problem, one.hypothesis, one.start, origin, none, expected=one.misfit)
        fitted = shaped(problem, origin, refine(problem, one.hypothesis, start, origin, rival), rival)
    except SimulationError:
        idle = np.concatenate([none.coefficients[: len(NUISANCES)], np.zeros(len(one.hypothesis.directions))])
        fitted = replace(none, hypothesis=one.hypothesis, coefficients=idle)
    return Trial(one, fitted, True)


def second_look(problem: Problem, origin: Point, found: Sequence[Trial], none: Fitted, say: Say) -> Trial | None:
    """The best effect with a second one, both fitted together; None where the best explains too little to begin with."""
    first = min((one.fitted for one in found if one.refined), key=lambda one: one.misfit, default=None)
    if first is None or first.hypothesis is None or first.misfit > SECOND * none.misfit:
        return None
    say(f"{first.hypothesis.effect} and a second effect, linearised")
    screened = screen(problem, first.point, first)
    pairs = [pair for one in screened[:PAIRS] if (pair := _pair(problem, origin, first, one, say))]
    best = min(pairs, key=lambda one: one.fitted.misfit, default=None)
    return best and _finished(problem, origin, best)


def _pair(problem: Problem, origin: Point, first: Fitted, second: Screened, say: Say) -> Trial | None:
    """Both effects fitted together on the full model; None where that cannot be simulated."""
    assert first.hypothesis is not None
    both = together(first.hypothesis, second.hypothesis)
    say(f"{both.effect}, on the full model")
    try:
        return Trial(second, shaped(problem, origin, refine(problem, both, second.start, origin)), True)
    except SimulationError:
        return None


def shaped(problem: Problem, origin: Point, fitted: Fitted, rival: float = float("inf")) -> Fitted:
    """The fit with what shapes its effects free as well (a frequency, a yield curvature), where more than noise is left."""
    assert fitted.hypothesis is not None
    shapes = shapes_of(fitted.hypothesis.parts or (fitted.hypothesis,), problem.longest)
    if not shapes or not LEFT * len(problem.data) < fitted.misfit < rival:
        return fitted
    whole = replace(together(fitted.hypothesis, *shapes), effect=fitted.hypothesis.effect)
    freed = refine(problem, whole, np.concatenate([fitted.coefficients, np.zeros(len(shapes))]), origin, rival)
    return freed if freed.misfit < WORTH * fitted.misfit else fitted
