"""Phases that differ from run to run: the angle of the sheave or the phase of a building's sway when a record begins.

A hypothesis with an amplitude and a phase has a cosine and a sine as directions. Each run is first given a pair of its own,
which one linear solution finds; a common amplitude with one phase for each run follows from the pairs.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.plant_parameters import Direction
from ..settings import ESTIMATES
from .gauss_newton import FitResult
from .weighted_least_squares import LeastSquaresProblem, solve_in_scale

Floats = NDArray[np.float64]


def with_per_run_phases(hypothesis: Hypothesis, files: Sequence[str]) -> Hypothesis:
    """The hypothesis with a phase of its own in each of the runs."""
    assert hypothesis.polar is not None
    name = hypothesis.polar[1]
    own = tuple(Direction(f"{name}@{file}", {}, ESTIMATES.run_phase_prior, -np.pi, np.pi) for file in files)
    return replace(hypothesis, directions=(*hypothesis.directions, *own), phase_runs=tuple(files))


def solve_per_run_phases(
    problem: LeastSquaresProblem, fit: FitResult, jacobian: Floats, hypothesis: Hypothesis
) -> tuple[Hypothesis, Floats, float]:
    """Linear estimate of an amplitude and a phase for each run about a fit.

    `jacobian` (N, 2) are the derivatives by the cosine and the sine. Returns the hypothesis with phases per run, the
    coefficients (those of `fit` first) and the chi-square.
    """
    pairs = np.hstack([jacobian * rows[:, None] for rows in problem.rows_of_runs])
    count, others, residual = len(problem.runs), problem.directions(fit.hypothesis), problem.residual(fit.predictions)
    begin = np.concatenate([fit.coefficients, np.zeros(2 * count)])
    solution = solve_in_scale(residual, np.hstack([fit.jacobian, pairs]), [*others, *hypothesis.directions * count], begin)
    z = np.array([complex(*pair) for pair in solution.coefficients[len(others) :].reshape(count, 2)])
    mean = z.sum() if abs(z.sum()) > 0.0 else complex(1.0)
    common = float(np.abs(z).mean()) * mean / abs(mean)
    phases = np.where(np.abs(z) > 0.0, np.angle(z / mean), 0.0)
    found = np.concatenate([solution.coefficients[: len(others)], [common.real, common.imag], phases])
    return with_per_run_phases(hypothesis, [run.file for run in problem.runs]), found, solution.chi_square
