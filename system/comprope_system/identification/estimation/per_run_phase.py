"""Phases that differ from run to run: nobody knows how a sheave stood, or a building swayed, when a record began.

A hypothesis with an amplitude and a phase has a cosine and a sine as directions. Here each run is given its own pair first,
which one linear solve finds; a common amplitude with one phase for each run follows from them.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..hypotheses.effect_hypotheses import Hypothesis
from ..hypotheses.plant_parameters import Direction
from ..settings import ESTIMATES
from .gauss_newton import FitResult
from .linearisation import fit_directions
from .weighted_least_squares import LeastSquaresProblem, solve_in_scale

Floats = NDArray[np.float64]


def with_per_run_phases(hypothesis: Hypothesis, files: Sequence[str]) -> Hypothesis:
    """The hypothesis with a phase for each of the runs."""
    assert hypothesis.polar is not None
    own = tuple(Direction(f"{hypothesis.polar[1]}@{file}", {}, ESTIMATES.run_phase_prior, -np.pi, np.pi) for file in files)
    return replace(hypothesis, directions=(*hypothesis.directions, *own), phase_runs=tuple(files))


def solve_per_run_phases(
    problem: LeastSquaresProblem, at: FitResult, by: Floats, hypothesis: Hypothesis
) -> tuple[Hypothesis, Floats, float]:
    """The hypothesis with own phases, coefficients (those of the fit `at` first), and the misfit, by one linear solve.

    `by` (N, 2) are derivatives by the cosine and the sine.
    """
    pairs = np.hstack([by * rows[:, None] for rows in problem.rows_of_runs])
    count, others, residual = len(problem.runs), fit_directions(at.hypothesis), problem.residual(at.predictions)
    begin = np.concatenate([at.coefficients, np.zeros(2 * count)])
    solution = solve_in_scale(residual, np.hstack([at.jacobian, pairs]), [*others, *hypothesis.directions * count], begin)
    z = np.array([complex(*pair) for pair in solution.coefficients[len(others) :].reshape(count, 2)])
    mean = z.sum() if abs(z.sum()) > 0.0 else complex(1.0)
    common = float(np.abs(z).mean()) * mean / abs(mean)
    turns = np.where(np.abs(z) > 0.0, np.angle(z / mean), 0.0)
    found = np.concatenate([solution.coefficients[: len(others)], [common.real, common.imag], turns])
    return with_per_run_phases(hypothesis, [run.file for run in problem.runs]), found, solution.chi_square
