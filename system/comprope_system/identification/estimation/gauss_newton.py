"""Gauss-Newton fit of plant and effect together, within bounds and with priors.

The derivatives of a run cost several plain runs. So they are carried from step to step by Broyden's rank-one update (1965),
which makes them exact along the last step, and are computed anew where a step gains much less than they predict, and at the end.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from comprope.errors import SimulationError

from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.parameter_point import ParameterPoint, Predictions
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..settings import GAUSS_NEWTON
from .linearisation import linearise, point_at
from .model_score import chi_square_resolution, penalised_chi_square
from .weighted_least_squares import LeastSquaresProblem, Solution, scale_of, solve

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class FitResult:
    """Fit of a hypothesis (None: plant alone): its point, predictions there, and the agreement with the data.

    `coefficients` (k,) are those of the plant, then of the effect, with their `covariance` (k, k); `jacobian` (N, k) are the
    derivatives of the whitened predictions by them. `chi_square` is the sum of squares of the whitened residual (N,),
    `prior_penalty` the sum of squares of coefficients over their priors' standard deviations. `prior_cost` is the cost of the
    plant's coefficients in the score, at the point or at the minimum that the linearisation predicts, whichever is less: a fit
    ends before the priors have pulled it to the minimum.
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
        """Objective of the fit: chi-square plus the prior penalty times `scale`."""
        return self.chi_square + scale * self.prior_penalty

    @property
    def penalised_chi_square(self) -> float:
        """Chi-square with the prior cost of the plant included."""
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
    """Fit of a hypothesis from the coefficients `start` (k,); `initial_fit` is the evaluation there, if it is known.

    A fit whose linearisation predicts a chi-square above `abandon_above` ends where it is. Raises `SimulationError` if the model
    cannot be simulated at `start`.
    """
    directions, count, fresh = problem.directions(hypothesis), len(problem.data), True
    best = initial_fit or evaluate(problem, hypothesis, np.asarray(start, float), base)
    for iteration in range(GAUSS_NEWTON.max_iterations):
        # With a large residual the priors are weighed by its mean square: else an implausible plant would imitate the effect.
        scale = scale_of(best.chi_square, count)
        solution = solve(problem.residual(best.predictions), best.jacobian, directions, best.coefficients, scale)
        best = _with_linear_prediction(problem, best, solution)
        trusted = iteration >= GAUSS_NEWTON.trusted_iteration
        if solution.chi_square > abandon_above * (1.0 if trusted else GAUSS_NEWTON.hopeless_factor):
            break
        enough, before = chi_square_resolution(best.chi_square, count, GAUSS_NEWTON.min_gain), best.cost(scale)
        predicted = before - solution.cost
        if predicted >= enough:
            # Where updated derivatives lead nowhere, shorter steps along them lead nowhere either.
            shares = GAUSS_NEWTON.step_fractions if fresh else GAUSS_NEWTON.step_fractions[:2]
            best = _line_search(problem, best, solution, base, scale, shares)
        gain = before - best.cost(scale)
        if fresh and gain < enough:
            break
        fresh = gain < max(enough, GAUSS_NEWTON.min_gain_ratio * predicted)
        if fresh:
            try:
                best = replace(evaluate(problem, hypothesis, best.coefficients, base), covariance=best.covariance)
            except SimulationError:  # derivatives diverge where the motion itself does not
                break
    return best


def fit_on_full_mesh(problem: LeastSquaresProblem, fitted: FitResult, base: ParameterPoint) -> FitResult:
    """A fit of the plant alone to a coarsened problem continued on the full mesh, where noise may explain what is left.

    Derivatives are computed there: with those of the coarse mesh, parameters that only their priors determine stay where the
    coarse fit has left them. Where much more is left than noise the fit is only evaluated. Raises `SimulationError` if the
    model cannot be simulated there.
    """
    (predictions,) = problem.predictions(fitted.point)
    residual = problem.residual(predictions)
    if (left := float(residual @ residual)) > GAUSS_NEWTON.far_from_data * len(problem.data):
        return replace(fitted, predictions=predictions, chi_square=left)
    return gauss_newton(problem, fitted.hypothesis, fitted.coefficients, base)


def evaluate(problem: LeastSquaresProblem, hypothesis: Hypothesis | None, x: Floats, base: ParameterPoint) -> FitResult:
    """Predictions and derivatives at the coefficients x (k,); raises `SimulationError` where the simulation fails."""
    predictions, jacobian = linearise(problem, hypothesis, x, base)
    return _fit_result(problem, hypothesis, x, base, predictions, jacobian)


def _fit_result(
    problem: LeastSquaresProblem,
    hypothesis: Hypothesis | None,
    x: Floats,
    base: ParameterPoint,
    predictions: Predictions,
    jacobian: Floats,
) -> FitResult:
    """Result at the coefficients x (k,), with a covariance yet to be found."""
    residual = problem.residual(predictions)
    penalty = float(sum((c / one.prior) ** 2 for c, one in zip(x, problem.directions(hypothesis), strict=True)))
    point, covariance = point_at(hypothesis, list(x), base), np.zeros((len(x), len(x)))
    chi_square = float(residual @ residual)
    return FitResult(hypothesis, point, predictions, x, covariance, jacobian, chi_square, penalty, problem.prior_cost(x))


def _with_linear_prediction(problem: LeastSquaresProblem, fitted: FitResult, solution: Solution) -> FitResult:
    """The fit with the covariance of its linear solution, and the lesser of both prior costs."""
    least = min(problem.prior_cost(fitted.coefficients), problem.prior_cost(solution.coefficients))
    return replace(fitted, covariance=solution.covariance, prior_cost=least)


def _line_search(
    problem: LeastSquaresProblem,
    best: FitResult,
    solution: Solution,
    base: ParameterPoint,
    scale: float,
    shares: Sequence[float],
) -> FitResult:
    """The longest of some shares of the step to the linear solution that decreases the cost; `best` if none does."""
    step = solution.coefficients - best.coefficients
    for share in shares:
        found = _broyden_step(problem, best, share * step, base)
        if found and found.cost(scale) < best.cost(scale):
            return replace(found, covariance=solution.covariance)
    return best


def _broyden_step(
    problem: LeastSquaresProblem, best: FitResult, step: Floats, base: ParameterPoint
) -> FitResult | None:
    """Result after a step (k,), with updated derivatives; None where it cannot be simulated.

    With the step s and W = diag(prior^-2), J+ = J + (y+ - y - J s) (W s)' / (s' W s).
    """
    x = best.coefficients + step
    (predictions,) = problem.attempts(point_at(best.hypothesis, list(x), base))
    if predictions is None:
        return None
    along = step / np.array([one.prior for one in problem.directions(best.hypothesis)]) ** 2
    error = problem.whitened(predictions) - problem.whitened(best.predictions) - best.jacobian @ step
    jacobian = best.jacobian + np.outer(error, along / float(along @ step))
    return _fit_result(problem, best.hypothesis, x, base, predictions, jacobian)
