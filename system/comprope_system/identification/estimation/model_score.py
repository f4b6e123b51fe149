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

EFFECTIVE_SAMPLES = 200.0  # independent looks that a campaign is worth
PENALTY_PER_PARAMETER = 2.5  # about half the logarithm of LOOKS: of the score, for each parameter of an effect
PENALTY_PER_RUN_PHASE = 1.0  # the same, for each run's own phase
ADEQUATE = 0.85  # misfit per datum below which there is nothing to explain
TAILS = 4.0  # degrees of freedom of Student's t: a data sheet may be wrong by more than data sheets usually are


def log_score(chi_square: float, count: int, complexity_penalty: float = 0.0) -> float:
    """Score of a misfit to `count` data: log likelihood of LOOKS independent looks whose scale is free, less its price."""
    return -0.5 * EFFECTIVE_SAMPLES * log(max(chi_square / count, ADEQUATE)) - complexity_penalty


def complexity_penalty(hypothesis: Hypothesis, alternatives: int) -> float:
    """What the score of a hypothesis is lowered by for all that was free to choose."""
    turns = sum(len(part.phase_runs) for part in hypothesis.parts or (hypothesis,))
    return PENALTY_PER_PARAMETER * (1 + len(hypothesis.directions) - turns) + PENALTY_PER_RUN_PHASE * turns + log(alternatives)


def prior_cost(coefficients: Sequence[float] | NDArray[np.float64]) -> float:
    """What a score is lowered by for a plant off its data sheets, minus the logarithm of Student's t; plant coefficients first.

    A load cell that shows an eighth too little is no sheave that is an eighth lighter, though both fit as well.
    """
    squares = [(float(c) / one.prior) ** 2 for c, one in zip(coefficients, PLANT_PARAMETERS, strict=False)]
    return 0.5 * (TAILS + 1.0) * sum(log1p(square / TAILS) for square in squares)


def penalised_chi_square(chi_square: float, cost: float) -> float:
    """The misfit, raised as a cost lowers its score."""
    return chi_square * exp(2.0 * cost / EFFECTIVE_SAMPLES)
