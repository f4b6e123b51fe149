"""What a hypothesis is worth: how little it misses, less its price, less how far it strains what data sheets say.

Scores compare misfits as ratios, as if LOOKS independent looks had been taken: the discrepancy of a model is one and the
same in thousands of samples, which a plain likelihood would count as evidence each.
"""

from collections.abc import Sequence
from math import exp, log, log1p

import numpy as np
from numpy.typing import NDArray

from ..hypotheses.effect_hypotheses import Hypothesis
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..settings import SCORE


def log_score(chi_square: float, count: int, complexity_penalty: float = 0.0) -> float:
    """Score of a misfit to `count` data: log likelihood of LOOKS independent looks whose scale is free, less its price."""
    return -0.5 * SCORE.effective_samples * log(max(chi_square / count, SCORE.adequate)) - complexity_penalty


def complexity_penalty(hypothesis: Hypothesis, alternatives: int) -> float:
    """What the score of a hypothesis is lowered by for all that was free to choose."""
    turns = sum(len(part.phase_runs) for part in hypothesis.parts or (hypothesis,))
    return (
        SCORE.parameter_penalty * (1 + len(hypothesis.directions) - turns) + SCORE.run_phase_penalty * turns + log(alternatives)
    )


def prior_cost(coefficients: Sequence[float] | NDArray[np.float64]) -> float:
    """What a score is lowered by for a plant off its data sheets, minus the logarithm of Student's t; plant coefficients first.

    A load cell that shows an eighth too little is no sheave that is an eighth lighter, though both fit as well.
    """
    squares = [(float(c) / one.prior) ** 2 for c, one in zip(coefficients, PLANT_PARAMETERS, strict=False)]
    return 0.5 * (SCORE.prior_degrees + 1.0) * sum(log1p(square / SCORE.prior_degrees) for square in squares)


def penalised_chi_square(chi_square: float, cost: float) -> float:
    """The misfit, raised as a cost lowers its score."""
    return chi_square * exp(2.0 * cost / SCORE.effective_samples)
