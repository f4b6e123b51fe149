"""Where a fit begins: the linear look bends the plant for what a large effect does, and misjudges the size of friction."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .fit import Fitted
from .hypotheses import NUISANCES, Hypothesis
from .linear import point_of
from .point import Point
from .problem import Problem

Floats = NDArray[np.float64]
FACTORS = (2.5, 0.4)
LONGEST = 3  # steps towards larger or smaller sizes


def best_start(
    problem: Problem, hypothesis: Hypothesis, start: Floats, origin: Point, none: Fitted, new: int | None = None
) -> Floats:
    """The best of some coefficients near `start` on the full model: three plants, then other sizes of the effect.

    The plants are that of the linear look, the model file's, and `none`'s, which is refitted without the effect.
    `new` is the number of the effect's directions, the first; by default all are.
    """
    count = len(NUISANCES)
    plants = (start[:count], np.zeros(count), none.coefficients[:count])
    starts = [np.concatenate([plant, start[count:]]) for plant in plants]
    missed = misfits(problem, hypothesis, starts, origin)
    best, least = starts[int(np.argmin(missed))], min(missed)
    sized = [resized(hypothesis, best, factor, new) for factor in FACTORS]
    missed = misfits(problem, hypothesis, sized, origin)
    factor = FACTORS[int(np.argmin(missed))]
    for _ in range(LONGEST):
        if min(missed) >= least:
            break
        best, least = sized[int(np.argmin(missed))], min(missed)
        sized = [resized(hypothesis, best, factor, new)]
        missed = misfits(problem, hypothesis, sized, origin)
    return best


def resized(hypothesis: Hypothesis, x: Floats, factor: float, new: int | None = None) -> Floats:
    """The coefficients with the effect's size multiplied, as far as bounds let it; phases stay."""
    grown, count = x.copy(), len(NUISANCES)
    for k, one in enumerate(hypothesis.directions[:new], count):
        if one.changes:
            grown[k] = min(max(factor * x[k], one.lower), one.upper)
    return grown


def misfits(problem: Problem, hypothesis: Hypothesis, starts: Sequence[Floats], origin: Point) -> list[float]:
    """Sums of squares at some coefficients; infinite where the model cannot be simulated."""
    tried = problem.attempts(*(point_of(hypothesis, list(start), origin) for start in starts))
    return [float(np.sum((problem.data - problem.whitened(at)) ** 2)) if at else float("inf") for at in tried]
