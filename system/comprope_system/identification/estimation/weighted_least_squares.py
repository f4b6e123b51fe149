"""Weighted least squares on the whitened channels of a campaign: the problem, and bounded linear estimates with priors."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from comprope.errors import SimulationError

from ..data.campaign import Campaign
from ..data.runs import Run
from ..data.whitening import WhitenedChannel, stack, whiten_channel
from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.parameter_point import ParameterPoint, Predictions, collect_predictions, submit_replays
from ..prediction.plant_parameters import Direction, fixed_parameters, plant_values, with_tolerances
from ..prediction.replay import coarsening_factor, relative_to_rest
from .model_score import prior_cost

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class LeastSquaresProblem:
    """Least-squares problem of some runs: `data` (N,) are whitened; with the right model chi-square is about N.

    `held` are plant parameters that stay as the model file or the run states them, `ruled_out` effects that are not considered.
    Elements and time steps of all replays are `coarse` times as long.
    """

    campaign: Campaign
    runs: tuple[Run, ...]
    whitened_channels: list[WhitenedChannel]
    data: Floats
    executor: Executor
    held: frozenset[str] = frozenset()
    ruled_out: frozenset[str] = frozenset()
    coarse: float = 1.0

    def coarsened(self, point: ParameterPoint, predictions: Predictions) -> "LeastSquaresProblem":
        """The same problem on the coarse mesh of screening, with `data` corrected by what that mesh changes at a point.

        `predictions` are those of this problem at the point. There both have the same residual; elsewhere the coarse mesh errs
        by as much as its error changes from there, at a fraction of the cost.
        """
        factor = coarsening_factor(self.campaign.model)
        if factor == 1.0 or (on_coarse_mesh := self.attempts(point, coarse=factor)[0]) is None:
            return self
        return self.corrected(factor, on_coarse_mesh, predictions)

    def on_coarse_mesh(self) -> "LeastSquaresProblem":
        """The same problem and data, replays on the coarse mesh of screening: for changes, whose error is a share of them."""
        return replace(self, coarse=coarsening_factor(self.campaign.model))

    def corrected(self, coarse: float, on_coarse_mesh: Predictions, predictions: Predictions) -> "LeastSquaresProblem":
        """The same problem on a mesh that is `coarse` times as long, with `data` corrected by how both predictions differ."""
        change = self.whitened(on_coarse_mesh) - self.whitened(predictions)
        return replace(self, data=self.data + change, coarse=coarse)

    @cached_property
    def plant(self) -> tuple[Direction, ...]:
        """The plant parameters with the campaign's priors."""
        return with_tolerances(self.campaign.tolerances, plant_values(self.campaign.model))

    def directions(self, hypothesis: Hypothesis | None) -> list[Direction]:
        """Directions of a fit: those of the plant, then those of the effect."""
        return [*self.plant, *(hypothesis.directions if hypothesis else ())]

    def prior_cost(self, coefficients: Floats) -> float:
        """Cost of a fit's plant coefficients in the score."""
        return prior_cost(coefficients, self.plant)

    def with_held_fixed(self, point: ParameterPoint) -> ParameterPoint:
        """The point with held plant parameters at their stated values."""
        return replace(point, plant={name: value for name, value in point.plant.items() if name not in self.held})

    def of_run(self, k: int) -> "LeastSquaresProblem":
        """The problem of run `k` alone."""
        run = self.runs[k]
        channels = [one for one in self.whitened_channels if one.run == run.file]
        return replace(self, runs=(run,), whitened_channels=channels, data=self.data[self.rows_of_runs[k]])

    def worst_run(self, squares: Floats) -> int:
        """Number of the run with the greatest mean of `squares` (N,)."""
        return int(np.argmax([squares[rows].sum() / max(rows.sum(), 1) for rows in self.rows_of_runs]))

    @cached_property
    def rows_of_runs(self) -> NDArray[np.bool_]:
        """Which data belong to which run: (runs, N)."""
        files = np.repeat([one.run for one in self.whitened_channels], [len(one.data) for one in self.whitened_channels])
        return np.array([files == run.file for run in self.runs])

    @property
    def longest(self) -> float:
        """Duration of the longest record [s]."""
        return max(float(run.time[-1] - run.time[0]) for run in self.runs)

    def predictions(self, *points: ParameterPoint) -> list[Predictions]:
        """Predictions at some points, computed in parallel."""
        coarse = self.coarse
        jobs = [submit_replays(self.campaign, self.runs, self.with_held_fixed(point), self.executor, coarse) for point in points]
        return [collect_predictions(self.runs, some) for some in jobs]

    def attempts(self, *points: ParameterPoint, coarse: float | None = None) -> list[Predictions | None]:
        """As `predictions`, None where the simulation fails; `coarse` replaces the factor of the problem's mesh."""
        coarse = coarse or self.coarse
        jobs = [submit_replays(self.campaign, self.runs, self.with_held_fixed(point), self.executor, coarse) for point in points]
        return [self._attempted(some) for some in jobs]

    def _attempted(self, jobs: Sequence[Future[dict[str, Floats]]]) -> Predictions | None:
        try:
            return collect_predictions(self.runs, jobs)
        except SimulationError:
            return None

    def whitened(self, predictions: Mapping[tuple[str, str], Floats]) -> Floats:
        """Predictions (N,), whitened as `data` are."""
        return stack(self.whitened_channels, predictions)

    def residual(self, predictions: Mapping[tuple[str, str], Floats]) -> Floats:
        """Whitened residual (N,): data less predictions."""
        return self.data - self.whitened(predictions)

    def column(self, values: Mapping[tuple[str, str], Floats]) -> Floats:
        """As `whitened` for some channels only, with zeros for the others (N,)."""
        zeros = {(one.run, one.column): np.zeros(len(one.bin_of)) for one in self.whitened_channels}
        return stack(self.whitened_channels, zeros | dict(values))


def build_problem(campaign: Campaign, runs: Sequence[Run], executor: Executor, nominal: Predictions) -> LeastSquaresProblem:
    """Whiten the channels of some runs; samples that are out of view in the nominal prediction are left out."""
    whitened_channels = []
    for run in runs:
        measured = relative_to_rest(run.values, run, campaign.channels)
        for column, channel in campaign.channels.items():
            one = whiten_channel(run, channel, measured[column], np.isfinite(nominal[run.file, column]), campaign.noise[column])
            if one:
                whitened_channels.append(one)
    data = np.concatenate([one.whiten(one.data) for one in whitened_channels]) if whitened_channels else np.zeros(0)
    held = fixed_parameters(campaign.tolerances)
    return LeastSquaresProblem(campaign, tuple(runs), whitened_channels, data, executor, held)


@dataclass(frozen=True)
class Solution:
    """Linear estimate: coefficients (k,), cost (chi-square plus scaled prior penalty), chi-square, and covariance (k, k)."""

    coefficients: Floats
    cost: float
    chi_square: float
    covariance: Floats


def solve(residual: Floats, matrix: Floats, directions: Sequence[Direction], start: Floats, scale: float = 1.0) -> Solution:
    """Most probable coefficients x (k,) of residual = matrix (x - start) + e within bounds, with normal priors.

    Minimises |residual - matrix (x - start)|^2 + scale |x / prior|^2. `scale` is the mean square of e: a model with a large
    error lends its priors more weight.
    """
    matrix, residual = compressed(matrix, residual)
    prior = np.array([one.prior for one in directions])
    rows = np.vstack([matrix, np.diag(scale**0.5 / prior)])
    target = np.concatenate([residual + matrix @ start, np.zeros(len(prior))])
    lower, upper = (np.array([getattr(one, side) for one in directions]) for side in ("lower", "upper"))
    found = lsq_linear(rows, target, (lower, upper)).x if len(prior) else prior
    left = residual - matrix @ (found - start)
    chi_square, prior_penalty = float(left @ left), float(((found / prior) ** 2).sum())
    curvature = np.eye(len(prior)) + prior[:, None] * (matrix.T @ matrix) * prior
    covariance = prior[:, None] * np.linalg.inv(curvature) * prior
    return Solution(found, chi_square + scale * prior_penalty, chi_square, covariance)


def solve_in_scale(residual: Floats, matrix: Floats, directions: Sequence[Direction], start: Floats) -> Solution:
    """As `solve`, with the mean square of the residual that a first estimate leaves as `scale`."""
    count = len(residual)
    matrix, residual = compressed(matrix, residual)
    sharp = solve(residual, matrix, directions, start)
    return solve(residual, matrix, directions, start, scale_of(sharp.chi_square, count))


def compressed(matrix: Floats, residual: Floats) -> tuple[Floats, Floats]:
    """Matrix (k + 1, k) and residual (k + 1,) of the same sum of squares for all coefficients: an orthogonal transform."""
    if len(residual) <= matrix.shape[1] + 1:
        return matrix, residual
    triangle = np.asarray(np.linalg.qr(np.column_stack([matrix, residual]), mode="r"))
    return triangle[:, :-1], triangle[:, -1]


def scale_of(chi_square: float, count: int) -> float:
    """Reduced chi-square of `count` data, at least 1: the mean square of the residual."""
    return max(1.0, chi_square / max(count, 1))
