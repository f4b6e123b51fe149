"""A rope heavier or lighter than its data sheet says: derivatives alone do not find it.

The rope's mass sets how long a swing takes. A model that is out of step by half a swing before a record ends is not led back
by derivatives, but to more damping, where there is no swing to be out of step with. So other masses are tried one after the
other, and for each all else is refitted by its derivatives.
"""

import numpy as np
from numpy.typing import NDArray

from .fit import Fitted, refine
from .hypotheses import NUISANCES
from .linear import directions_of, point_of
from .point import Point
from .problem import Problem, Solution, solve_in_scale
from .replay import coarseness

Floats = NDArray[np.float64]
MASS = [one.name for one in NUISANCES].index("rope.mass_per_length")
REACH = 0.24  # logarithm of the mass: how far from the data sheet
APART = 0.04  # between two masses: twenty swings come out of step by 2.5 rad
PROMISING = 0.9  # of the misfit: what another mass must promise
LEFT = 1.05  # misfit per datum above which there is something to look for


def in_step(problem: Problem, begun: Fitted, base: Point) -> Floats:
    """Coefficients (k,) with a mass that brings the model into step; those of `begun` where none promises to."""
    here = begun.coefficients
    count, offsets = len(problem.data), _offsets(float(here[MASS]))
    if others_refitted(problem, begun, problem.whitened(begun.predictions), here).misfit < LEFT * count:
        return here
    tried = [here + offset * (np.arange(len(here)) == MASS) for offset in offsets]
    at = problem.attempts(*(point_of(begun.hypothesis, list(x), base) for x in tried), coarse=coarseness(problem.campaign.model))
    found = {
        offset: others_refitted(problem, begun, problem.whitened(predictions), x)
        for offset, x, predictions in zip(offsets, tried, at, strict=True)
        if predictions is not None
    }
    best = min(found, key=lambda offset: found[offset].misfit, default=0.0)
    if 0.0 not in found or found[best].misfit > PROMISING * found[0.0].misfit:
        return here
    return found[best].coefficients


def _offsets(mass: float) -> list[float]:
    """Steps to masses within REACH of the data sheet's, none among them."""
    steps = int(2.0 * REACH / APART)
    return [APART * k for k in range(-steps, steps + 1) if k == 0 or abs(mass + APART * k) <= REACH]


def others_refitted(problem: Problem, begun: Fitted, whitened: Floats, x: Floats) -> Solution:
    """All coefficients refitted about x by the derivatives of `begun`."""
    return solve_in_scale(problem.data - whitened, begun.by, directions_of(begun.hypothesis), x)


def refitted(problem: Problem, begun: Fitted, base: Point) -> Fitted:
    """The best point near `begun`, or near where another mass brings it into step."""
    start = in_step(problem, begun, base)
    return refine(problem, begun.hypothesis, start, base, begun=begun if start is begun.coefficients else None)


def brought_into_step(problem: Problem, fitted: Fitted, base: Point) -> Fitted:
    """The fit, or a better one with another mass."""
    start = in_step(problem, fitted, base)
    if start is fitted.coefficients:
        return fitted
    return min(fitted, refine(problem, fitted.hypothesis, start, base, fitted.misfit), key=lambda one: one.misfit)
