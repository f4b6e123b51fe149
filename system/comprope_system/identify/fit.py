"""Fits of one hypothesis: Gauss and Newton's method on plant and effect together, within bounds and priors."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from comprope.errors import SimulationError

from .hypotheses import NUISANCES, Direction, Hypothesis
from .linear import directions_of, linearised, misfits, point_of
from .point import Point, Predictions
from .problem import Problem, Solution, scale_of, solve

Floats = NDArray[np.float64]
ENOUGH = 2e-3  # of the number of data: a fall of the cost below this ends the iteration
ROUNDS = 15
TRUSTED = 3  # rounds after which what a fit expects is believed: friction answers to its size by far other than a line
HOPELESS = 6.0  # times the rival that a fit may expect in these rounds before it is given up all the same
SHORTER = (0.3, 0.1, 0.03)  # of a step that leads uphill


@dataclass(frozen=True)
class Fitted:
    """The best point of a hypothesis (None: nothing is missing), its predictions and how well they agree.

    `misfit` is the sum of squares in units of noise and discrepancy, `penalty` that of coefficients over priors;
    `coefficients` are plant first, then the effect; `deviation` their standard deviations; `by` (N, coefficients) are
    the derivatives there.
    """

    hypothesis: Hypothesis | None
    point: Point
    predictions: Predictions
    coefficients: Floats
    deviation: Floats
    by: Floats
    misfit: float
    penalty: float

    def cost(self, scale: float = 1.0) -> float:
        """Misfit and priors in its scale."""
        return self.misfit + scale * self.penalty

    @property
    def effect_coefficients(self) -> list[float]:
        """Coefficients of the effect's directions."""
        return [float(c) for c in self.coefficients[len(NUISANCES) :]]


def refine(
    problem: Problem,
    hypothesis: Hypothesis | None,
    start: Floats,
    base: Point,
    rival: float = float("inf"),
    begun: tuple[Predictions, Floats] | None = None,
) -> Fitted:
    """The best point near `start`; `begun` are predictions and derivatives there, where they are known.

    A fit that expects to end above `rival` is left where it is. Raises `SimulationError` if `start` cannot be simulated.
    """
    directions, x = directions_of(hypothesis), np.asarray(start, float)
    best, count = _evaluate(problem, hypothesis, x, base, directions, begun), len(problem.data)
    for done in range(ROUNDS):
        # While much is missed, the plant's priors count in the scale of that: a wild plant would hide what is missing.
        scale = scale_of(best.misfit, count)
        solution = solve(problem.data - problem.whitened(best.predictions), best.by, directions, best.coefficients, scale)
        best = replace(best, deviation=solution.deviation)
        hopeless = solution.misfit > rival * (1.0 if done >= TRUSTED else HOPELESS)
        if hopeless or best.cost(scale) - solution.cost < ENOUGH * scale * count:
            break
        found = _downhill(problem, best, solution, base, scale)
        gain, best = best.cost(scale) - found.cost(scale), found
        if gain < ENOUGH * scale * count:
            break
    return best


def _evaluate(
    problem: Problem,
    hypothesis: Hypothesis | None,
    x: Floats,
    base: Point,
    directions: Sequence[Direction],
    known: tuple[Predictions, Floats] | None = None,
) -> Fitted:
    predictions, by = known or linearised(problem, hypothesis, x, base)
    residual = problem.data - problem.whitened(predictions)
    misfit = float(residual @ residual)
    point, none = point_of(hypothesis, list(x), base), np.zeros(len(x))
    return Fitted(hypothesis, point, predictions, x, none, by, misfit, _penalty(x, directions))


def _penalty(x: Floats, directions: Sequence[Direction]) -> float:
    return float(sum((c / one.prior) ** 2 for c, one in zip(x, directions, strict=True)))


def _downhill(problem: Problem, best: Fitted, solution: Solution, base: Point, scale: float) -> Fitted:
    """The solution's point, or one nearer to the present where that one is worse than it or cannot be simulated."""
    step, directions = solution.coefficients - best.coefficients, directions_of(best.hypothesis)
    for x in _lengths(problem, best, step, base, scale, directions):
        with suppress(SimulationError):
            found = _evaluate(problem, best.hypothesis, x, base, directions)
            if found.cost(scale) < best.cost(scale):
                return replace(found, deviation=solution.deviation)
    return best


def _lengths(
    problem: Problem, best: Fitted, step: Floats, base: Point, scale: float, directions: Sequence[Direction]
) -> Iterator[Floats]:
    """Where the whole step leads, then the best of the shorter ones, which are looked at without derivatives first."""
    yield best.coefficients + step
    nearer = [best.coefficients + share * step for share in SHORTER]
    missed = misfits(problem, best.hypothesis, nearer, base)
    costs = [misfit + scale * _penalty(x, directions) for misfit, x in zip(missed, nearer, strict=True)]
    if min(costs) < best.cost(scale):
        yield nearer[int(np.argmin(costs))]
