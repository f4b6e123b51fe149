"""Fits of one hypothesis: Gauss and Newton's method on plant and effect together, within bounds and priors.

Derivatives along a run cost several plain runs. So they are carried from step to step by Broyden's update (1965), which makes
them right along the step just made, and found anew where a step gives much less than they promise, and at the end.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..hypotheses.effect_hypotheses import Hypothesis
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint, Predictions
from ..settings import GAUSS_NEWTON
from .linearisation import fit_directions, linearise, point_at
from .model_score import penalised_chi_square, prior_cost
from .weighted_least_squares import LeastSquaresProblem, Solution, scale_of, solve

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class FitResult:
    """The best point of a hypothesis (None: nothing is missing), its predictions and how well they agree.

    `misfit` is the sum of squares in units of noise and discrepancy, `penalty` that of coefficients over priors;
    `coefficients` are plant first, then the effect; `covariance` theirs; `jacobian` (N, coefficients) are the
    derivatives there. `strain` is what the plant's coefficients cost, there or where derivatives lead from there: a fit
    ends before priors have pulled all they could.
    """

    hypothesis: Hypothesis | None
    point: ParameterPoint
    predictions: Predictions
    coefficients: Floats
    covariance: Floats
    jacobian: Floats
    chi_square: float
    prior_penalty: float
    prior_cost: float

    def cost(self, scale: float = 1.0) -> float:
        """Misfit and priors in its scale."""
        return self.chi_square + scale * self.prior_penalty

    @property
    def penalised_chi_square(self) -> float:
        """The misfit, raised for a plant off its data sheets."""
        return penalised_chi_square(self.chi_square, self.prior_cost)

    @property
    def effect_coefficients(self) -> list[float]:
        """Coefficients of the effect's directions."""
        return [float(c) for c in self.coefficients[len(PLANT_PARAMETERS) :]]


def gauss_newton(
    problem: LeastSquaresProblem,
    hypothesis: Hypothesis | None,
    start: Floats,
    base: ParameterPoint,
    abandon_above: float = float("inf"),
    initial_fit: FitResult | None = None,
) -> FitResult:
    """The best point near `start`; `begun` is what is known of `start`.

    A fit that expects to end above `rival` is left where it is. Raises `SimulationError` if `start` cannot be simulated.
    """
    directions, count, fresh = fit_directions(hypothesis), len(problem.data), True
    best = initial_fit or evaluate(problem, hypothesis, np.asarray(start, float), base)
    for done in range(GAUSS_NEWTON.max_iterations):
        # While much is missed, the plant's priors count in the scale of that: a wild plant would hide what is missing.
        scale = scale_of(best.chi_square, count)
        solution = solve(problem.residual(best.predictions), best.jacobian, directions, best.coefficients, scale)
        best = _seen_from(best, solution)
        if solution.chi_square > abandon_above * (
            1.0 if done >= GAUSS_NEWTON.trusted_iteration else GAUSS_NEWTON.hopeless_factor
        ):
            break
        enough, promised, before = GAUSS_NEWTON.min_decrease * scale * count, best.cost(scale) - solution.cost, best.cost(scale)
        if promised >= enough:
            best = _downhill(problem, best, solution, base, scale)
        gain = before - best.cost(scale)
        if fresh and gain < enough:
            break
        fresh = gain < max(enough, GAUSS_NEWTON.min_gain_ratio * promised)
        if fresh:
            best = replace(evaluate(problem, hypothesis, best.coefficients, base), covariance=best.covariance)
    return best


def _seen_from(fitted: FitResult, solution: Solution) -> FitResult:
    """The fit with what the solution by its derivatives tells."""
    least = min(prior_cost(fitted.coefficients), prior_cost(solution.coefficients))
    return replace(fitted, covariance=solution.covariance, prior_cost=least)


def evaluate(problem: LeastSquaresProblem, hypothesis: Hypothesis | None, x: Floats, base: ParameterPoint) -> FitResult:
    """Misfit and derivatives at the coefficients x (k,). Raises `SimulationError` where the model cannot be simulated there."""
    return _fitted(problem, hypothesis, x, base, *linearise(problem, hypothesis, x, base))


def _fitted(
    problem: LeastSquaresProblem,
    hypothesis: Hypothesis | None,
    x: Floats,
    base: ParameterPoint,
    predictions: Predictions,
    by: Floats,
) -> FitResult:
    residual = problem.residual(predictions)
    prior_penalty = float(sum((c / one.prior) ** 2 for c, one in zip(x, fit_directions(hypothesis), strict=True)))
    point, none = point_at(hypothesis, list(x), base), np.zeros((len(x), len(x)))
    return FitResult(hypothesis, point, predictions, x, none, by, float(residual @ residual), prior_penalty, prior_cost(x))


def _downhill(problem: LeastSquaresProblem, best: FitResult, solution: Solution, base: ParameterPoint, scale: float) -> FitResult:
    """The solution's point, or one nearer to the present where that one is worse than it or cannot be simulated."""
    step = solution.coefficients - best.coefficients
    for shares in ((1.0,), GAUSS_NEWTON.step_fractions):
        tried = _stepped(problem, best, [share * step for share in shares], base)
        found = min(tried, key=lambda one: one.cost(scale), default=best)
        if found.cost(scale) < best.cost(scale):
            return replace(found, covariance=solution.covariance)
    return best


def _stepped(problem: LeastSquaresProblem, best: FitResult, steps: Sequence[Floats], base: ParameterPoint) -> list[FitResult]:
    """Those points some steps away that can be simulated, with derivatives carried along the step."""
    found, y = [], problem.whitened(best.predictions)
    widths = np.array([one.prior for one in fit_directions(best.hypothesis)])
    reached = [best.coefficients + step for step in steps]
    at = problem.attempts(*(point_at(best.hypothesis, list(x), base) for x in reached))
    for x, step, predictions in zip(reached, steps, at, strict=True):
        if predictions is not None:
            along = step / widths**2
            missed = problem.whitened(predictions) - y - best.jacobian @ step
            by = best.jacobian + np.outer(missed, along / float(along @ step))
            found.append(_fitted(problem, best.hypothesis, x, base, predictions, by))
    return found
