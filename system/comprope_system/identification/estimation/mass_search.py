"""A rope heavier or lighter than its data sheet says: derivatives alone do not find it.

The rope's mass sets how long a swing takes. A model that is out of step by half a swing before a record ends is not led back
by derivatives, but to more damping, where there is no swing to be out of step with. So other masses are tried one after the
other, and for each all else is refitted by its derivatives.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..hypotheses.plant_parameters import NUISANCES
from ..prediction.parameter_point import Point, Predictions
from ..prediction.replay import coarseness
from .gauss_newton import Fitted, refine
from .linearisation import directions_of, point_of
from .weighted_least_squares import Problem, Solution, solve_in_scale

Floats = NDArray[np.float64]
MASS = [one.name for one in NUISANCES].index("rope.mass_per_length")
REACH = 0.24  # logarithm of the mass: how far from the data sheet
APART = 0.04  # between two masses: twenty swings come out of step by 2.5 rad
PROMISING = 0.9  # of the misfit: what another mass must promise
LEFT = 1.05  # misfit per datum above which there is something to look for


def in_step(problem: Problem, begun: Fitted, base: Point) -> Floats | None:
    """Coefficients (k,) with a mass that brings the model into step; None where no other mass promises to."""
    here = begun.coefficients
    present = float(here[MASS])
    if _refitted(problem, begun, begun.predictions, here).misfit < LEFT * len(problem.data):
        return None
    looks = at_masses(problem, begun, base, _masses(present), coarseness(problem.campaign.model))
    found = {float(x[MASS]): solution for x, _, solution in looks}
    best = min(found, key=lambda mass: found[mass].misfit, default=present)
    if present not in found or found[best].misfit > PROMISING * found[present].misfit:
        return None
    return found[best].coefficients


def _masses(present: float) -> list[float]:
    """Masses within REACH of the data sheet's, and the present one."""
    steps = int(2.0 * REACH / APART)
    return [present + APART * k for k in range(-steps, steps + 1) if k == 0 or abs(present + APART * k) <= REACH]


def at_masses(
    problem: Problem, begun: Fitted, base: Point, masses: Sequence[float], coarse: float = 1.0
) -> list[tuple[Floats, Predictions, Solution]]:
    """The fit `begun` with each of some masses: coefficients (k,), predictions, and all refitted by the derivatives of `begun`.

    Masses with which the model cannot be simulated are left out.
    """
    tried = [np.where(np.arange(len(begun.coefficients)) == MASS, mass, begun.coefficients) for mass in masses]
    at = problem.attempts(*(point_of(begun.hypothesis, list(x), base) for x in tried), coarse=coarse)
    return [(x, seen, _refitted(problem, begun, seen, x)) for x, seen in zip(tried, at, strict=True) if seen is not None]


def _refitted(problem: Problem, begun: Fitted, predictions: Predictions, x: Floats) -> Solution:
    """All coefficients refitted about x by the derivatives of `begun`."""
    return solve_in_scale(problem.residual(predictions), begun.by, directions_of(begun.hypothesis), x)


def refitted(problem: Problem, begun: Fitted, base: Point) -> Fitted:
    """The best point near `begun`, or near where another mass brings it into step."""
    start = in_step(problem, begun, base)
    if start is None:
        return refine(problem, begun.hypothesis, begun.coefficients, base, begun=begun)
    return refine(problem, begun.hypothesis, start, base)


def brought_into_step(problem: Problem, fitted: Fitted, base: Point) -> Fitted:
    """The fit, or a better one with another mass."""
    start = in_step(problem, fitted, base)
    if start is None:
        return fitted
    return min(fitted, refine(problem, fitted.hypothesis, start, base, fitted.misfit), key=lambda one: one.misfit)
