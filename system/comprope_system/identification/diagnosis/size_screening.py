"""Screening at several sizes: what each effect would explain if it were much larger than a derivative reaches.

Dry friction, hysteresis and delay do not act in proportion to their size: twice the friction is no twofold response, and where it
holds the sheave the response no longer resembles that of a little friction. Each amplitude is therefore simulated at several
sizes, from the plant as stated and as refitted, and the plant's parameters are refitted linearly there, together
with the size along the secant. One run decides, the one of which least is explained. Delays shift the predictions and need no
simulation.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import REGISTRY

from ..estimation.gauss_newton import FitResult
from ..estimation.linearisation import with_effect
from ..estimation.weighted_least_squares import LeastSquaresProblem, solve_in_scale
from ..prediction.effect_hypotheses import Hypothesis, effect_hypotheses, instrument_hypotheses
from ..prediction.parameter_point import ParameterPoint, Predictions
from ..prediction.replay import delayed, relative_to_rest
from ..settings import HYPOTHESES, SCREENING
from .linear_screening import ScreenedHypothesis, best_per_effect, imitable_responses, orthogonal_response

Floats = NDArray[np.float64]


def screen_at_sizes(
    problem: LeastSquaresProblem, origin: ParameterPoint, fits: Sequence[FitResult]
) -> list[ScreenedHypothesis]:
    """Best size and variant of every effect that does not act in proportion, most promising first, about each of some fits.

    The first of `fits` is that of the plant; what it leaves is most in the one run that is simulated here, and the chi-squares
    found there are scaled to all runs.
    """
    squares = problem.residual(fits[0].predictions) ** 2
    k = problem.worst_run(squares)
    rows, whole = problem.rows_of_runs[k], squares.sum()
    screened = _screen_one_run(problem.of_run(k), origin, [replace(fit, jacobian=fit.jacobian[rows]) for fit in fits])
    share = float(whole / squares[rows].sum())
    return best_per_effect([_of_all_runs(one, share, rows) for one in screened])


def with_sizes(
    screened: Sequence[ScreenedHypothesis], sized: Sequence[ScreenedHypothesis]
) -> list[ScreenedHypothesis]:
    """The linear screening with the start of each effect replaced by that of the size that explains more."""
    by_effect = {one.hypothesis.effect: one for one in sized}
    found = []
    for one in screened:
        other = by_effect.get(one.hypothesis.effect, one)
        if _same_variant(one, other):  # responses in all runs tell effects apart better than those in one
            other = replace(one, start=other.start, chi_square=other.chi_square, sized=True)
        found.append(one if one.chi_square <= other.chi_square else other)
    return sorted(found, key=lambda one: one.penalised_chi_square)


def _same_variant(one: ScreenedHypothesis, other: ScreenedHypothesis) -> bool:
    names = [[direction.name for direction in screened.hypothesis.directions] for screened in (one, other)]
    return names[0] == names[1] and one.hypothesis.fixed == other.hypothesis.fixed


def _of_all_runs(one: ScreenedHypothesis, share: float, rows: NDArray[np.bool_]) -> ScreenedHypothesis:
    """What was screened on one run, scaled to the problem of all runs, in which it has the given `rows` (N,)."""
    orthogonal = np.zeros((len(rows), one.orthogonal_part.shape[1]))
    orthogonal[rows] = one.orthogonal_part
    return replace(one, chi_square=share * one.chi_square, orthogonal_part=orthogonal)


def _screen_one_run(
    problem: LeastSquaresProblem, origin: ParameterPoint, fits: Sequence[FitResult]
) -> list[ScreenedHypothesis]:
    """All variants, each at all sizes, on the problem of one run."""
    left_out = {key.split(".")[1] for key in origin.effects} | problem.ruled_out
    known = [
        one
        for one in effect_hypotheses(problem.campaign.model)
        if one.effect not in left_out and not one.polar and not REGISTRY[one.effect].proportional
    ]
    screened: list[ScreenedHypothesis] = []
    for fit in fits:
        screened += _effects_at_sizes(problem, fit, known)
        if "sensor_delay" not in left_out:
            screened += _delays(problem, fit)
    return screened


def _effects_at_sizes(
    problem: LeastSquaresProblem, fit: FitResult, known: Sequence[Hypothesis]
) -> Iterator[ScreenedHypothesis]:
    """Every amplitude of every effect at every size, beside the plant of a fit; what cannot be simulated is left out."""
    tried = [
        (one, k, size)
        for one in known
        for k, direction in enumerate(one.directions)
        for size in sorted({max(min(size, direction.upper), direction.lower) for size in SCREENING.sizes})
    ]
    points = [with_effect(fit.point, one, [size * (j == k) for j in range(len(one.directions))]) for one, k, size in tried]
    before, *after = problem.attempts(fit.point, *points)
    if before is None:
        return
    unaffected, imitable = problem.whitened(before), imitable_responses(problem, fit)
    for (one, k, size), predictions in zip(tried, after, strict=True):
        if predictions is not None:
            change = problem.whitened(predictions) - unaffected
            variants = len(SCREENING.sizes) * sum(other.effect == one.effect for other in known)
            yield _at_size(problem, fit, imitable, one, (k, size, change), variants)


def _delays(problem: LeastSquaresProblem, fit: FitResult) -> Iterator[ScreenedHypothesis]:
    """A delay of each channel by every time that is tried."""
    channels, imitable = problem.campaign.channels, imitable_responses(problem, fit)
    faults = [one for one in instrument_hypotheses(channels) if one.effect == "sensor_delay"]
    for one in faults:
        column = one.directions[0].name.split(".", 2)[2]
        for delay in SCREENING.delays:
            change = problem.column(_delayed_less_plain(problem, fit.predictions, column, delay))
            variants = len(SCREENING.delays) * len(faults)
            yield _at_size(problem, fit, imitable, one, (0, delay / HYPOTHESES.delay_unit, change), variants)


def _delayed_less_plain(problem: LeastSquaresProblem, predictions: Predictions, column: str, delay: float) -> Predictions:
    """Change of a channel in every run by a delay [s]."""
    found = {}
    for run in problem.runs:
        value = predictions[run.file, column]
        late = relative_to_rest({column: delayed(run.time, value, delay)}, run, problem.campaign.channels)
        found[run.file, column] = late[column] - value
    return found


def _at_size(
    problem: LeastSquaresProblem,
    fit: FitResult,
    imitable: Floats,
    one: Hypothesis,
    at: tuple[int, float, Floats],
    variants: int,
) -> ScreenedHypothesis:
    """Hypothesis screened about amplitude k at a size, `at` = (k, size, change of the whitened predictions (N,)).

    `imitable` are the responses that the fit's parameters imitate.
    """
    k, size, change = at
    others, count = problem.directions(fit.hypothesis), len(one.directions)
    secant = np.outer(change / size, np.arange(count) == k)
    start = np.concatenate([fit.coefficients, size * (np.arange(count) == k)])
    matrix, directions = np.hstack([fit.jacobian, secant]), [*others, *one.directions]
    solution = solve_in_scale(problem.residual(fit.predictions) - change, matrix, directions, start)
    orthogonal, distinct = orthogonal_response(secant, imitable)
    cost = problem.prior_cost(solution.coefficients)
    return ScreenedHypothesis(
        one, solution.coefficients, solution.chi_square, cost, orthogonal, distinct, variants, sized=True
    )
