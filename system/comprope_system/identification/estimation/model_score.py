"""Score of a model: log likelihood, less a penalty for its complexity and the cost of its plant parameters under their priors.

Scores compare chi-squares as ratios, as if a campaign were `SCORE.effective_samples` independent samples with unknown scale:
the discrepancy of a model is the same in thousands of samples, each of which a plain likelihood would count as evidence.
With the penalty of about half the logarithm of that number for each parameter it is a BIC (Schwarz 1978).
"""

from collections.abc import Sequence
from math import exp, log, log1p

import numpy as np
from numpy.typing import NDArray

from ..hypotheses.effect_hypotheses import Hypothesis
from ..hypotheses.plant_parameters import PLANT_PARAMETERS, Direction
from ..settings import SCORE


def log_score(chi_square: float, count: int, penalty: float = 0.0) -> float:
    """Logarithm of the score of a chi-square of `count` data: -n/2 log(chi^2 / count) less `penalty`, n effective samples."""
    return -0.5 * SCORE.effective_samples * log(max(chi_square / count, SCORE.adequate)) - penalty


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
    """Chi-square that has without a penalty the score of `chi_square` with the penalty `cost`."""
    return chi_square * exp(2.0 * cost / SCORE.effective_samples)
