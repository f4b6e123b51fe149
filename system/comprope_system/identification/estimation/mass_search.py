"""Search over the rope's mass, which sets the period of its oscillations.

A model that is more than half a period out of phase at the end of a record is led by derivatives to more damping, where
nothing oscillates that could be out of phase, instead of to another mass (cycle skipping). So the mass is tried on a grid,
and for each mass all other parameters are refitted linearly.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from comprope.errors import SimulationError

from ..prediction.parameter_point import ParameterPoint, Predictions
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..prediction.replay import coarsening_factor
from ..settings import MASS_SEARCH
from .gauss_newton import FitResult, gauss_newton
from .linearisation import point_at
from .model_score import NoiseLevel, log_score
from .weighted_least_squares import LeastSquaresProblem, Solution, solve_in_scale

Floats = NDArray[np.float64]
MASS = [one.name for one in PLANT_PARAMETERS].index("rope.mass_per_length")


def fit_with_mass_search(problem: LeastSquaresProblem, initial_fit: FitResult, base: ParameterPoint) -> FitResult:
    """Gauss-Newton fit from `initial_fit`, or from a better mass of the rope if there is one."""
    start = _start_at_better_mass(problem, initial_fit, base)
    if start is None:
        return gauss_newton(problem, initial_fit.hypothesis, initial_fit.coefficients, base, initial_fit=initial_fit)
    return gauss_newton(problem, initial_fit.hypothesis, start, base)


def search_rope_mass(problem: LeastSquaresProblem, fitted: FitResult, base: ParameterPoint) -> FitResult:
    """The fit, or a better one from another mass of the rope."""
    start = _start_at_better_mass(problem, fitted, base)
    if start is None:
        return fitted
    try:
        other = gauss_newton(problem, fitted.hypothesis, start, base, fitted.chi_square)
    except SimulationError:
        return fitted
    return min(fitted, other, key=lambda one: one.chi_square)


def fits_at_masses(
    problem: LeastSquaresProblem, initial_fit: FitResult, base: ParameterPoint, masses: Sequence[float], coarse: float = 1.0
) -> list[tuple[Floats, Predictions, Solution]]:
    """The model at other masses of the rope: coefficients (k,), predictions, and all coefficients refitted linearly.

    `masses` are logarithms of factors; the derivatives are those of `initial_fit`. Masses at which the simulation fails are
    left out.
    """
    at_mass = np.arange(len(initial_fit.coefficients)) == MASS
    tried = [np.where(at_mass, mass, initial_fit.coefficients) for mass in masses]
    predicted = problem.attempts(*(point_at(initial_fit.hypothesis, list(x), base) for x in tried), coarse=coarse)
    return [
        (x, one, _refit_linearly(problem, initial_fit, one, x))
        for x, one in zip(tried, predicted, strict=True)
        if one is not None
    ]


def _start_at_better_mass(problem: LeastSquaresProblem, initial_fit: FitResult, base: ParameterPoint) -> Floats | None:
    """Coefficients (k,) with a better mass of the rope; None where no other mass promises a sufficient improvement."""
    current = float(initial_fit.coefficients[MASS])
    k = problem.worst_run(problem.residual(initial_fit.predictions) ** 2)  # one run decides which mass is tried in all
    own = replace(initial_fit, jacobian=initial_fit.jacobian[problem.rows_of_runs[k]])
    found = _fits_by_mass(problem.of_run(k), own, base, _mass_grid(current))
    best = min(found, key=lambda mass: found[mass].cost, default=current)
    if not promises(found, best, current, problem.rows_of_runs[k].sum()):
        return None
    found = _fits_by_mass(problem, initial_fit, base, [current, best])
    return found[best].coefficients if promises(found, best, current, len(problem.data)) else None


def _fits_by_mass(
    problem: LeastSquaresProblem, initial_fit: FitResult, base: ParameterPoint, masses: Sequence[float]
) -> dict[float, Solution]:
    """Linear refits at some masses on the coarse mesh, by mass."""
    fits = fits_at_masses(problem, initial_fit, base, masses, coarsening_factor(problem.campaign.model))
    return {float(x[MASS]): solution for x, _, solution in fits}


def promises(found: Mapping[float, Solution], mass: float, current: float, count: int) -> bool:
    """Whether the linear refits to `count` data promise a better score at another mass, priors included."""
    if mass == current or not {mass, current} <= set(found):
        return False
    noise = NoiseLevel.of_fits(count, [found[mass].chi_square])
    gain = log_score(found[mass].cost, noise) - log_score(found[current].cost, noise)
    return gain > MASS_SEARCH.min_gain


def _mass_grid(current: float) -> list[float]:
    """The current mass and grid points within reach of the data sheet's, as logarithms of factors."""
    steps = int(2.0 * MASS_SEARCH.reach / MASS_SEARCH.spacing)
    grid = [(k, current + MASS_SEARCH.spacing * k) for k in range(-steps, steps + 1)]
    return [mass for k, mass in grid if k == 0 or abs(mass) <= MASS_SEARCH.reach]


def _refit_linearly(problem: LeastSquaresProblem, initial_fit: FitResult, predictions: Predictions, x: Floats) -> Solution:
    """All coefficients refitted about x (k,) with the derivatives of `initial_fit`."""
    return solve_in_scale(problem.residual(predictions), initial_fit.jacobian, problem.directions(initial_fit.hypothesis), x)
