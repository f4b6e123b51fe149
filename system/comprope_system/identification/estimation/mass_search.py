"""A rope heavier or lighter than its data sheet says: derivatives alone do not find it.

The rope's mass sets how long a swing takes. A model that is out of step by half a swing before a record ends is not led back
by derivatives, but to more damping, where there is no swing to be out of step with. So other masses are tried one after the
other, and for each all else is refitted by its derivatives.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint, Predictions
from ..prediction.replay import coarsening_factor
from ..settings import MASS_SEARCH
from .gauss_newton import FitResult, gauss_newton
from .linearisation import fit_directions, point_at
from .weighted_least_squares import LeastSquaresProblem, Solution, solve_in_scale

Floats = NDArray[np.float64]
MASS = [one.name for one in PLANT_PARAMETERS].index("rope.mass_per_length")


def _start_at_better_mass(problem: LeastSquaresProblem, initial_fit: FitResult, base: ParameterPoint) -> Floats | None:
    """Coefficients (k,) with a mass that brings the model into step; None where no other mass promises to."""
    here = initial_fit.coefficients
    current = float(here[MASS])
    if _refit_linearised(problem, initial_fit, initial_fit.predictions, here).chi_square < MASS_SEARCH.adequate * len(
        problem.data
    ):
        return None
    looks = fits_at_masses(problem, initial_fit, base, _masses(current), coarsening_factor(problem.campaign.model))
    found = {float(x[MASS]): solution for x, _, solution in looks}
    best = min(found, key=lambda mass: found[mass].chi_square, default=current)
    if current not in found or found[best].chi_square > MASS_SEARCH.min_improvement * found[current].chi_square:
        return None
    return found[best].coefficients


def _masses(current: float) -> list[float]:
    """Masses within MASS_SEARCH.reach of the data sheet's, and the present one."""
    steps = int(2.0 * MASS_SEARCH.reach / MASS_SEARCH.spacing)
    return [
        current + MASS_SEARCH.spacing * k
        for k in range(-steps, steps + 1)
        if k == 0 or abs(current + MASS_SEARCH.spacing * k) <= MASS_SEARCH.reach
    ]


def fits_at_masses(
    problem: LeastSquaresProblem, initial_fit: FitResult, base: ParameterPoint, masses: Sequence[float], coarse: float = 1.0
) -> list[tuple[Floats, Predictions, Solution]]:
    """The fit `begun` with each of some masses: coefficients (k,), predictions, and all refitted by the derivatives of `begun`.

    Masses with which the model cannot be simulated are left out.
    """
    tried = [np.where(np.arange(len(initial_fit.coefficients)) == MASS, mass, initial_fit.coefficients) for mass in masses]
    at = problem.attempts(*(point_at(initial_fit.hypothesis, list(x), base) for x in tried), coarse=coarse)
    return [
        (x, seen, _refit_linearised(problem, initial_fit, seen, x)) for x, seen in zip(tried, at, strict=True) if seen is not None
    ]


def _refit_linearised(problem: LeastSquaresProblem, initial_fit: FitResult, predictions: Predictions, x: Floats) -> Solution:
    """All coefficients refitted about x by the derivatives of `begun`."""
    return solve_in_scale(problem.residual(predictions), initial_fit.jacobian, fit_directions(initial_fit.hypothesis), x)


def fit_with_mass_search(problem: LeastSquaresProblem, initial_fit: FitResult, base: ParameterPoint) -> FitResult:
    """The best point near `begun`, or near where another mass brings it into step."""
    start = _start_at_better_mass(problem, initial_fit, base)
    if start is None:
        return gauss_newton(problem, initial_fit.hypothesis, initial_fit.coefficients, base, initial_fit=initial_fit)
    return gauss_newton(problem, initial_fit.hypothesis, start, base)


def search_rope_mass(problem: LeastSquaresProblem, fitted: FitResult, base: ParameterPoint) -> FitResult:
    """The fit, or a better one with another mass."""
    start = _start_at_better_mass(problem, fitted, base)
    if start is None:
        return fitted
    return min(fitted, gauss_newton(problem, fitted.hypothesis, start, base, fitted.chi_square), key=lambda one: one.chi_square)
