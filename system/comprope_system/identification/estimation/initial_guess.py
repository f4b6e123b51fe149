"""Initial guess of a nonlinear fit.

Linear screening distorts the plant's parameters to imitate a large effect, and misjudges the size of friction. It also
distributes what one amplitude does among several: dry and viscous friction have similar responses. So other plants, other
sizes, and each amplitude alone are tried on the full model.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.parameter_point import ParameterPoint
from ..prediction.plant_parameters import PLANT_PARAMETERS
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
    """Coefficients (k,) of least chi-square among some near `start`: three plants, then other sizes of the effect.

    The plants are those of the screening, of the model file, and of `baseline`, the fit without the effect. `new` is the
    number of the effect's directions, the first ones; by default all. Nothing else is tried where the chi-square at `start` is
    near the one `expected` by screening.
    """
    count = len(PLANT_PARAMETERS)
    plants = (start[:count], np.zeros(count), baseline.coefficients[:count])
    starts = [np.concatenate([plant, start[count:]]) for plant in plants]
    tried = chi_squares(problem, hypothesis, starts[:1], origin)
    if tried[0] - expected < INITIAL_GUESS.linearity * min(expected, baseline.chi_square - expected):
        return start
    tried += chi_squares(problem, hypothesis, starts[1:], origin)
    best, least = starts[int(np.argmin(tried))], min(tried)
    factors = INITIAL_GUESS.size_factors
    guesses = [best, *single_amplitudes(hypothesis, best, new)]
    sized = [scaled_effect(hypothesis, one, factor, new) for one in guesses for factor in factors]
    tried = chi_squares(problem, hypothesis, sized, origin)
    factor = factors[int(np.argmin(tried)) % len(factors)]
    for _ in range(INITIAL_GUESS.max_size_steps):
        if min(tried) >= least:
            break
        best, least = sized[int(np.argmin(tried))], min(tried)
        sized = [scaled_effect(hypothesis, best, factor, new)]
        tried = chi_squares(problem, hypothesis, sized, origin)
    return best


def scaled_effect(hypothesis: Hypothesis, x: Floats, factor: float, new: int | None = None) -> Floats:
    """The coefficients (k,) with the effect's amplitudes multiplied within their bounds; phases are kept."""
    scaled, count = x.copy(), len(PLANT_PARAMETERS)
    for k, one in enumerate(hypothesis.directions[:new], count):
        if one.changes:
            scaled[k] = min(max(factor * x[k], one.lower), one.upper)
    return scaled


def single_amplitudes(hypothesis: Hypothesis, x: Floats, new: int | None = None) -> list[Floats]:
    """The coefficients (k,) with each of the effect's amplitudes alone; empty for one amplitude, or a cosine and a sine."""
    count, polar = len(PLANT_PARAMETERS), any(part.polar for part in hypothesis.parts or (hypothesis,))
    amplitudes = range(count, count + len(hypothesis.directions[:new]))
    if polar or len(amplitudes) < 2:
        return []
    return [np.where(np.isin(np.arange(len(x)), [j for j in amplitudes if j != k]), 0.0, x) for k in amplitudes if x[k]]


def chi_squares(
    problem: LeastSquaresProblem, hypothesis: Hypothesis | None, tried: Sequence[Floats], base: ParameterPoint
) -> list[float]:
    """Chi-square at each of some coefficients (k,); infinite where the simulation fails."""
    found = problem.attempts(*(point_at(hypothesis, list(x), base) for x in tried))
    return [float(np.sum(problem.residual(one) ** 2)) if one else float("inf") for one in found]
