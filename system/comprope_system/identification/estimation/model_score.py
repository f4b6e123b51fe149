"""Score of a model: log likelihood, less a penalty for its complexity and the cost of its plant parameters under their priors.

What a fit leaves of N whitened data is noise, N s^2, and a discrepancy of the model. The noise is another one in each datum, so
that each is evidence; the discrepancy is the same in thousands of data and counts as n = `SCORE.effective_samples` amplitudes of
unknown size. The likelihood of chi^2 = s^2 (N + m N + E) is then that of Student's t distribution,

    log L = -n/2 log(1 + E/n):

half of chi^2 / s^2 where E is small, n/2 log(chi^2) where it is most of chi^2. The share m = `SCORE.model_error` is what mesh,
time step, recovered trip and noise model err by, which an absent effect may imitate. The least chi^2 of the fits to be compared
tells s^2. With the penalty of about half the logarithm of n for each parameter it is a BIC (Schwarz 1978).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import exp, log, log1p

import numpy as np
from numpy.typing import NDArray

from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.plant_parameters import PLANT_PARAMETERS, Direction
from ..settings import SCORE


@dataclass(frozen=True)
class NoiseLevel:
    """Number N of whitened data, and the reduced chi-square s^2 that noise alone leaves of them."""

    count: int
    reduced: float

    @classmethod
    def of_fits(cls, count: int, chi_squares: Iterable[float]) -> "NoiseLevel":
        """The least of the fits' reduced chi-squares, as far as it can be noise."""
        return cls(count, min([SCORE.noise_limit, *(one / count for one in chi_squares)]))

    def discrepancy(self, chi_square: float) -> float:
        """Discrepancy E in what a fit leaves beyond the model's own error, in units of the noise of one datum."""
        return max(chi_square - self.explained, 0.0) / self.reduced

    @property
    def explained(self) -> float:
        """Chi-square that noise and the model's own error explain."""
        return (1.0 + SCORE.model_error) * self.count * self.reduced


def log_score(chi_square: float, noise: NoiseLevel, penalty: float = 0.0) -> float:
    """Logarithm of the score of a fit's chi-square: -n/2 log(1 + E/n) less `penalty`."""
    return -0.5 * SCORE.effective_samples * log1p(noise.discrepancy(chi_square) / SCORE.effective_samples) - penalty


def least_noticed(chi_square: float, noise: NoiseLevel, cost: float) -> float:
    """Least increase of chi-square above that of the best fit that lowers the log score by `cost`."""
    raised = (SCORE.effective_samples + noise.discrepancy(chi_square)) * exp(2.0 * cost / SCORE.effective_samples)
    return noise.explained + noise.reduced * (raised - SCORE.effective_samples) - chi_square


def chi_square_resolution(chi_square: float, count: int, gain: float) -> float:
    """Decrease of the chi-square of `count` data by which the log score rises by `gain`: a share of it far from the data."""
    noise = NoiseLevel.of_fits(count, [chi_square])
    return 2.0 * gain * noise.reduced * (1.0 + noise.discrepancy(chi_square) / SCORE.effective_samples)


def complexity_penalty(hypothesis: Hypothesis, alternatives: int) -> float:
    """Penalty for the parameters of a hypothesis, for the phases of single runs, and for the choice among `alternatives`."""
    phases = sum(len(part.phase_runs) for part in hypothesis.parts or (hypothesis,))
    parameters = 1 + len(hypothesis.directions) - phases
    return SCORE.parameter_penalty * parameters + SCORE.run_phase_penalty * phases + log(alternatives)


def prior_cost(coefficients: Sequence[float] | NDArray[np.float64], plant: Sequence[Direction] = PLANT_PARAMETERS) -> float:
    """Cost of plant parameters away from their data sheets: negative logarithm of Student's t; coefficients of the plant first.

    A load cell that reads an eighth too low must not be explained by a sheave that is an eighth lighter, which fits as well.
    """
    squares = [(float(c) / one.prior) ** 2 for c, one in zip(coefficients, plant, strict=False)]
    return 0.5 * (SCORE.prior_degrees + 1.0) * sum(log1p(square / SCORE.prior_degrees) for square in squares)


def penalised_chi_square(chi_square: float, cost: float) -> float:
    """Chi-square of a discrepancy that has without a penalty the score of `chi_square` with the penalty `cost`."""
    return chi_square * exp(2.0 * cost / SCORE.effective_samples)
