"""Fit of every effect: on the full nonlinear model where that is worth its time, else as linear screening predicts it."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from comprope.errors import SimulationError

from ..estimation.gauss_newton import FitResult, gauss_newton
from ..estimation.initial_guess import best_initial_guess
from ..estimation.mass_search import search_rope_mass
from ..estimation.model_score import complexity_penalty, log_score
from ..estimation.weighted_least_squares import LeastSquaresProblem
from ..hypotheses.effect_hypotheses import Hypothesis, combine
from ..hypotheses.model_effects import shape_hypotheses
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint
from ..progress import ProgressCallback
from ..settings import CANDIDATES, MASS_SEARCH
from .linear_screening import ScreenedHypothesis, indistinguishable, screen_hypotheses


class CandidateFit(NamedTuple):
    """An effect's linear look, its fit, and whether that is one on the full model."""

    screening: ScreenedHypothesis
    fitted: FitResult
    refined: bool

    @property
    def hypothesis(self) -> Hypothesis:
        """What is fitted."""
        assert self.fitted.hypothesis is not None
        return self.fitted.hypothesis

    def log_score(self, count: int) -> float:
        """Score of the fit to `count` data."""
        return log_score(
            self.fitted.chi_square,
            count,
            complexity_penalty(self.hypothesis, self.screening.alternatives) + self.fitted.prior_cost,
        )


def fit_candidates(
    problem: LeastSquaresProblem,
    origin: ParameterPoint,
    screened: list[ScreenedHypothesis],
    baseline: FitResult,
    report_progress: ProgressCallback,
) -> list[CandidateFit]:
    """Every effect fitted: the promising ones on the full model, the others as the linear look has them.

    A linear look alone does not win: whichever leads is fitted as well, until what leads is a fit.
    """
    worth = CANDIDATES.min_improvement * len(problem.data)
    found = [_from_screening(one, baseline) for one in screened]
    least = max(CANDIDATES.min_share * (baseline.penalised_chi_square - found[0].fitted.penalised_chi_square), worth)
    for k, one in enumerate(screened[: CANDIDATES.max_fits]):
        if baseline.penalised_chi_square - found[k].fitted.penalised_chi_square > least and _may_win(found[k], baseline, found):
            found[k] = _on_full_model(problem, origin, one, baseline, found, report_progress)
    leader = _leader(found, len(problem.data))
    while not found[leader].refined and found[leader].fitted.penalised_chi_square < baseline.penalised_chi_square - worth:
        found[leader] = _on_full_model(problem, origin, screened[leader], baseline, found, report_progress)
        leader = _leader(found, len(problem.data))
    if found[leader].refined:
        found[leader] = _finished(problem, origin, found[leader])
        _fit_indistinguishable(problem, origin, screened, baseline, found, leader, report_progress)
    return found


def _fit_indistinguishable(
    problem: LeastSquaresProblem,
    origin: ParameterPoint,
    screened: Sequence[ScreenedHypothesis],
    baseline: FitResult,
    found: list[CandidateFit],
    leader: int,
    report_progress: ProgressCallback,
) -> None:
    """Fit what looks like the leader as well: of two effects with much the same trace a linear look may have misjudged one."""
    for k, one in enumerate(screened):
        if not found[k].refined and indistinguishable(one, screened[leader]):
            found[k] = _on_full_model(problem, origin, one, baseline, found, report_progress)


def refit_from_other_masses(
    problem: LeastSquaresProblem,
    origin: ParameterPoint,
    screened: Sequence[ScreenedHypothesis],
    baseline: FitResult,
    found: Sequence[CandidateFit],
    report_progress: ProgressCallback,
) -> list[CandidateFit]:
    """The trials, or better ones of the same effects that begin where `screened` saw them."""
    trials = {one.hypothesis.effect: one for one in found}
    for one in screened[: CANDIDATES.max_mass_fits]:
        if one.chi_square < CANDIDATES.mass_improvement * least_chi_square(trials.values(), baseline):
            trial = _finished(
                problem, origin, _on_full_model(problem, origin, one, baseline, list(trials.values()), report_progress)
            )
            known = trials.setdefault(one.hypothesis.effect, trial)
            trials[one.hypothesis.effect] = min(known, trial, key=lambda own: own.fitted.chi_square)
    return list(trials.values())


def _finished(problem: LeastSquaresProblem, origin: ParameterPoint, one: CandidateFit) -> CandidateFit:
    """The trial with another mass, if that brings it into step, and what shapes its effects free there."""
    moved = search_rope_mass(problem, one.fitted, origin)
    return one if moved is one.fitted else one._replace(fitted=free_shape_parameters(problem, origin, moved))


def least_chi_square(found: Iterable[CandidateFit], baseline: FitResult) -> float:
    """Misfit of the best fit."""
    return min((one.fitted.chi_square for one in found if one.refined), default=baseline.chi_square)


def _may_win(one: CandidateFit, baseline: FitResult, found: Sequence[CandidateFit]) -> bool:
    """Whether an effect that explains half as much again as its linear look has it would come near the best fit so far."""
    at_best = one.fitted.penalised_chi_square - CANDIDATES.optimism * (
        baseline.penalised_chi_square - one.fitted.penalised_chi_square
    )
    return at_best < CANDIDATES.near_factor * min(
        (trial.fitted.penalised_chi_square for trial in found if trial.refined), default=baseline.penalised_chi_square
    )


def _leader(found: Sequence[CandidateFit], count: int) -> int:
    return max(range(len(found)), key=lambda k: found[k].log_score(count))


def _from_screening(one: ScreenedHypothesis, baseline: FitResult) -> CandidateFit:
    """The fit that a linear look promises."""
    fitted = replace(
        baseline, hypothesis=one.hypothesis, coefficients=one.start, chi_square=one.chi_square, prior_cost=one.prior_cost
    )
    return CandidateFit(one, fitted, False)


def _on_full_model(
    problem: LeastSquaresProblem,
    origin: ParameterPoint,
    one: ScreenedHypothesis,
    baseline: FitResult,
    found: Sequence[CandidateFit],
    report_progress: ProgressCallback,
) -> CandidateFit:
    """The effect fitted; one that cannot be simulated explains nothing. A fit ends early once it cannot come near the best."""
    report_progress(f"{one.hypothesis.effect}, on the full model")
    abandon_above = CANDIDATES.abandon_factor * min(
        (trial.fitted.chi_square for trial in found if trial.refined), default=float("inf")
    )
    try:
        start = best_initial_guess(problem, one.hypothesis, one.start, origin, baseline, expected=one.chi_square)
        fitted = free_shape_parameters(
            problem, origin, gauss_newton(problem, one.hypothesis, start, origin, abandon_above), abandon_above
        )
    except SimulationError:
        idle = np.concatenate([baseline.coefficients[: len(PLANT_PARAMETERS)], np.zeros(len(one.hypothesis.directions))])
        fitted = replace(baseline, hypothesis=one.hypothesis, coefficients=idle)
    return CandidateFit(one, fitted, True)


def fit_pair(
    problem: LeastSquaresProblem,
    origin: ParameterPoint,
    found: Sequence[CandidateFit],
    baseline: FitResult,
    report_progress: ProgressCallback,
) -> CandidateFit | None:
    """The best effect with a second one, both fitted together; None where the best explains too little to begin with."""
    first = min((one.fitted for one in found if one.refined), key=lambda one: one.chi_square, default=None)
    if first is None or first.hypothesis is None or first.chi_square > CANDIDATES.pair_threshold * baseline.chi_square:
        return None
    report_progress(f"{first.hypothesis.effect} and a second effect, linearised")
    screened = screen_hypotheses(problem, first.point, first)
    pairs = [pair for one in screened[: CANDIDATES.max_pairs] if (pair := _pair(problem, origin, first, one, report_progress))]
    best = min(pairs, key=lambda one: one.fitted.chi_square, default=None)
    return best and _finished(problem, origin, best)


def _pair(
    problem: LeastSquaresProblem,
    origin: ParameterPoint,
    first: FitResult,
    second: ScreenedHypothesis,
    report_progress: ProgressCallback,
) -> CandidateFit | None:
    """Both effects fitted together on the full model; None where that cannot be simulated."""
    assert first.hypothesis is not None
    both = combine(first.hypothesis, second.hypothesis)
    report_progress(f"{both.effect}, on the full model")
    try:
        return CandidateFit(
            second, free_shape_parameters(problem, origin, gauss_newton(problem, both, second.start, origin)), True
        )
    except SimulationError:
        return None


def free_shape_parameters(
    problem: LeastSquaresProblem, origin: ParameterPoint, fitted: FitResult, abandon_above: float = float("inf")
) -> FitResult:
    """The fit with what shapes its effects free as well (a frequency, a yield curvature), where more than noise is left."""
    assert fitted.hypothesis is not None
    shapes = shape_hypotheses(fitted.hypothesis.parts or (fitted.hypothesis,), problem.longest)
    if not shapes or not MASS_SEARCH.adequate * len(problem.data) < fitted.chi_square < abandon_above:
        return fitted
    whole = replace(combine(fitted.hypothesis, *shapes), effect=fitted.hypothesis.effect)
    freed = gauss_newton(problem, whole, np.concatenate([fitted.coefficients, np.zeros(len(shapes))]), origin, abandon_above)
    return freed if freed.chi_square < CANDIDATES.shape_improvement * fitted.chi_square else fitted
