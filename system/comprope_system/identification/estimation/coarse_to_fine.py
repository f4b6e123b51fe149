"""Fits made on a coarse mesh and continued on the full one, at a fraction of the cost of a fit on the full mesh alone."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comprope.errors import SimulationError

from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.parameter_point import ParameterPoint, Predictions
from ..settings import CANDIDATES, REPLAY
from .gauss_newton import FitResult, evaluate, fit_on_full_mesh, gauss_newton
from .linearisation import point_at
from .mass_search import fit_with_mass_search
from .weighted_least_squares import LeastSquaresProblem, solve

Floats = NDArray[np.float64]


class FitFromFile(NamedTuple):
    """Fit of the parameters that a model has: the coarse problem, its evaluation at the start, and the fit on the full mesh."""

    rough: LeastSquaresProblem
    initial: FitResult
    fitted: FitResult


def fit_from_file(
    problem: LeastSquaresProblem,
    hypothesis: Hypothesis | None,
    start: Floats,
    base: ParameterPoint,
    nominal: Predictions,
    *,
    search_mass: bool = True,
) -> FitFromFile:
    """Fit from the coefficients `start` (k,), at which the full mesh predicts `nominal`, or from a better mass of the rope.

    Raises `SimulationError` if the model cannot be simulated there.
    """
    rough = problem.coarsened(point_at(hypothesis, list(start), base), nominal)
    initial = evaluate(rough, hypothesis, start, base)
    if search_mass:
        fitted = fit_with_mass_search(rough, initial, base)
    else:
        fitted = gauss_newton(rough, hypothesis, start, base, initial_fit=initial)
    if rough.coarse != problem.coarse and hypothesis is None:
        fitted = fit_on_full_mesh(problem, fitted, base)
    elif rough.coarse != problem.coarse:  # effects are reported, whatever is left
        fitted = gauss_newton(problem, hypothesis, fitted.coefficients, base)
    return FitFromFile(rough, initial, fitted)


def problem_of_fits(problem: LeastSquaresProblem, rough: LeastSquaresProblem, baseline: FitResult) -> LeastSquaresProblem:
    """The problem on the coarse mesh, corrected about the plant's fit; on its own mesh where that errs too much.

    `rough` is corrected about the point at which the plant's fit began. How the correction has changed from there tells by how
    much the coarse mesh errs elsewhere, beside what the plant's fit leaves beyond noise. Where that fit explains the data little
    is left to be fitted, and the coarse mesh serves.
    """
    coarse, count = problem.coarsened(baseline.point, baseline.predictions), len(problem.data)
    error = float(np.sum((rough.data - coarse.data) ** 2))
    explained = baseline.chi_square <= CANDIDATES.explained * count
    return coarse if explained or error <= REPLAY.coarse_error * (baseline.chi_square - count) else problem


def fit_coarse_to_fine(
    problem: LeastSquaresProblem, hypothesis: Hypothesis | None, start: Floats, base: ParameterPoint
) -> FitResult:
    """Fit from the coefficients `start` (k,), about which the coarse mesh is corrected.

    Raises `SimulationError` if the model cannot be simulated there.
    """
    point = point_at(hypothesis, list(start), base)
    rough = problem.coarsened(point, problem.predictions(point)[0])
    fitted = gauss_newton(rough, hypothesis, start, base)
    return fitted if rough.coarse == problem.coarse else gauss_newton(problem, hypothesis, fitted.coefficients, base)


def with_derivatives(problem: LeastSquaresProblem, fitted: FitResult, base: ParameterPoint) -> FitResult:
    """The fit with derivatives computed at its point on the problem's mesh, for its standard errors.

    Those that a fit has carried along from a coarse mesh may give errors that are wrong by a factor of two. Where they cannot be
    computed the fit is returned as it is.
    """
    try:
        there = evaluate(problem, fitted.hypothesis, fitted.coefficients, base)
    except SimulationError:  # derivatives diverge where the motion itself does not
        return fitted
    directions = problem.directions(fitted.hypothesis)
    solution = solve(problem.residual(there.predictions), there.jacobian, directions, there.coefficients)
    return replace(there, covariance=solution.covariance, prior_cost=fitted.prior_cost)
