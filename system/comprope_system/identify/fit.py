"""Fits of one hypothesis: Gauss and Newton's method on plant and effect together, within bounds and priors."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .hypotheses import NUISANCES, Direction, Hypothesis
from .linear import by_effect, by_plant, with_effect
from .point import Point, Predictions
from .problem import Problem, Solution, solve

Floats = NDArray[np.float64]
ENOUGH = 2e-3  # of the number of data: a fall of the cost below this ends the iteration
ROUNDS = 6
HALVINGS = 3


@dataclass(frozen=True)
class Fitted:
    """The best point of a hypothesis (None: nothing is missing), its predictions and how well they agree.

    `cost` and `misfit` are squares in units of noise and discrepancy; `evidence` is the log of Laplace's.
    `coefficients` are plant first, then the effect; `deviation` their standard deviations.
    """

    hypothesis: Hypothesis | None
    point: Point
    predictions: Predictions
    coefficients: Floats
    deviation: Floats
    cost: float
    misfit: float
    evidence: float

    @property
    def effect_coefficients(self) -> list[float]:
        """Coefficients of the effect's directions."""
        return [float(c) for c in self.coefficients[len(NUISANCES) :]]


def directions_of(hypothesis: Hypothesis | None) -> list[Direction]:
    """The directions of a fit: the plant's, then the effect's."""
    return [*NUISANCES, *(hypothesis.directions if hypothesis else ())]


def point_of(hypothesis: Hypothesis | None, coefficients: Sequence[float], base: Point) -> Point:
    """The point of these coefficients, beside the effects that `base` has."""
    names = [one.name for one in NUISANCES]
    plant = replace(base, plant=dict(zip(names, map(float, coefficients[: len(names)]), strict=True)))
    return with_effect(plant, hypothesis, [float(c) for c in coefficients[len(names) :]]) if hypothesis else plant


def refine(
    problem: Problem, hypothesis: Hypothesis | None, start: Floats, base: Point, plant: Floats, rounds: int = ROUNDS
) -> Fitted:
    """The best point near `start`; `plant` (N, nuisances) are derivatives that may have been taken elsewhere.

    They are taken anew where they no longer lead downhill.
    """
    directions, x = directions_of(hypothesis), np.asarray(start, float)
    best = _evaluate(problem, hypothesis, x, base, directions)
    fresh = False
    for _ in range(rounds):
        matrix = np.hstack([plant, _effect_part(problem, hypothesis, best, base)])
        solution = solve(problem.data - problem.whitened(best.predictions), matrix, directions, best.coefficients)
        found = _downhill(problem, best, solution, base, directions)
        gain = best.cost - found.cost
        best = replace(found, evidence=solution.evidence + 0.5 * (solution.cost - found.cost), deviation=solution.deviation)
        if gain < ENOUGH * len(problem.data):
            if fresh or gain > 0.0:
                break
            plant, fresh = by_plant(problem, best.point, problem.whitened(best.predictions)), True
    return best


def _effect_part(problem: Problem, hypothesis: Hypothesis | None, at: Fitted, base: Point) -> Floats:
    if hypothesis is None:
        return np.zeros((len(problem.data), 0))
    plant = replace(base, plant=at.point.plant)
    return by_effect(problem, hypothesis, plant, at.effect_coefficients, at.predictions)


def _evaluate(problem: Problem, hypothesis: Hypothesis | None, x: Floats, base: Point, directions: Sequence[Direction]) -> Fitted:
    point = point_of(hypothesis, list(x), base)
    (predictions,) = problem.predictions(point)
    residual = problem.data - problem.whitened(predictions)
    misfit = float(residual @ residual)
    penalty = float(sum((c / one.prior) ** 2 for c, one in zip(x, directions, strict=True)))
    return Fitted(hypothesis, point, predictions, x, np.zeros(len(x)), misfit + penalty, misfit, -0.5 * (misfit + penalty))


def _downhill(problem: Problem, best: Fitted, solution: Solution, base: Point, directions: Sequence[Direction]) -> Fitted:
    """The solution's point, or one nearer to the present where that one is worse than it."""
    step = solution.coefficients - best.coefficients
    for _ in range(HALVINGS):
        found = _evaluate(problem, best.hypothesis, best.coefficients + step, base, directions)
        if found.cost < best.cost:
            return found
        step = 0.3 * step
    return best
