"""Where a fit begins: the linear look bends the plant for what a large effect does, and misjudges the size of friction.

It also shares out among an effect's amplitudes what one of them does alone: dry and viscous friction look much the same to it.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..hypotheses.effect_hypotheses import Hypothesis
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint
from ..settings import INITIAL_GUESS
from .gauss_newton import FitResult
from .linearisation import point_at
from .weighted_least_squares import LeastSquaresProblem

Floats = NDArray[np.float64]


def best_initial_guess(
    problem: LeastSquaresProblem,
    hypothesis: Hypothesis,
    start: Floats,
    origin: ParameterPoint,
    baseline: FitResult,
    new: int | None = None,
    expected: float = 0.0,
) -> Floats:
    """The best of some coefficients near `start` on the full model: three plants, then other sizes of the effect.

    The plants are that of the linear look, the model file's, and `none`'s, which is refitted without the effect; each of
    several amplitudes is tried alone as well. `new` is the number of the effect's directions, the first; by default all are.
    Nothing else is tried where `start` has the misfit that the linear look `expected`.
    """
    count = len(PLANT_PARAMETERS)
    plants = (start[:count], np.zeros(count), baseline.coefficients[:count])
    starts = [np.concatenate([plant, start[count:]]) for plant in plants]
    missed = chi_squares(problem, hypothesis, starts[:1], origin)
    if missed[0] - expected < INITIAL_GUESS.linearity * min(expected, baseline.chi_square - expected):
        return start
    missed += chi_squares(problem, hypothesis, starts[1:], origin)
    best, least = starts[int(np.argmin(missed))], min(missed)
    sized = [
        resized(hypothesis, one, factor, new)
        for one in [best, *alone(hypothesis, best, new)]
        for factor in INITIAL_GUESS.size_factors
    ]
    missed = chi_squares(problem, hypothesis, sized, origin)
    factor = INITIAL_GUESS.size_factors[int(np.argmin(missed)) % len(INITIAL_GUESS.size_factors)]
    for _ in range(INITIAL_GUESS.max_size_steps):
        if min(missed) >= least:
            break
        best, least = sized[int(np.argmin(missed))], min(missed)
        sized = [resized(hypothesis, best, factor, new)]
        missed = chi_squares(problem, hypothesis, sized, origin)
    return best


def resized(hypothesis: Hypothesis, x: Floats, factor: float, new: int | None = None) -> Floats:
    """The coefficients with the effect's size multiplied, as far as bounds let it; phases stay."""
    grown, count = x.copy(), len(PLANT_PARAMETERS)
    for k, one in enumerate(hypothesis.directions[:new], count):
        if one.changes:
            grown[k] = min(max(factor * x[k], one.lower), one.upper)
    return grown


def alone(hypothesis: Hypothesis, x: Floats, new: int | None = None) -> list[Floats]:
    """The coefficients with each of the effect's amplitudes alone; none where there is one only, or a cosine and a sine."""
    count, polar = len(PLANT_PARAMETERS), any(part.polar for part in hypothesis.parts or (hypothesis,))
    sized = range(count, count + len(hypothesis.directions[:new]))
    if polar or len(sized) < 2:
        return []
    return [np.where(np.isin(np.arange(len(x)), [j for j in sized if j != k]), 0.0, x) for k in sized if x[k]]


def chi_squares(
    problem: LeastSquaresProblem, hypothesis: Hypothesis | None, tried: Sequence[Floats], base: ParameterPoint
) -> list[float]:
    """Sums of squares at some coefficients (k,); infinite where the model cannot be simulated."""
    found = problem.attempts(*(point_at(hypothesis, list(x), base) for x in tried))
    return [float(np.sum(problem.residual(at) ** 2)) if at else float("inf") for at in found]
