"""The weighed misfit of a campaign: whitened data, predictions and directions, and bounded fits of coefficients."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from .campaign import Campaign, Run
from .hypotheses import Direction
from .point import Point, Predictions, gathered, submit
from .replay import referred
from .samples import Part, part, stack

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Problem:
    """Some runs of a campaign, binned and weighed. `data` (N,) is whitened; its expected square is N."""

    campaign: Campaign
    runs: tuple[Run, ...]
    parts: list[Part]
    data: Floats
    executor: Executor

    def predictions(self, *points: Point) -> list[Predictions]:
        """The model's channels at some points, computed side by side."""
        jobs = [submit(self.campaign, self.runs, point, self.executor) for point in points]
        return [gathered(self.runs, some) for some in jobs]

    def whitened(self, predictions: Mapping[tuple[str, str], Floats]) -> Floats:
        """Predictions (N,) in the units of `data`."""
        return stack(self.parts, predictions)

    def column(self, values: Mapping[tuple[str, str], Floats]) -> Floats:
        """Like `whitened`, for some channels only: zero for the others."""
        none = {(one.run, one.column): np.zeros(len(one.of)) for one in self.parts}
        return stack(self.parts, none | dict(values))


def pose(campaign: Campaign, runs: Sequence[Run], executor: Executor, nominal: Predictions) -> Problem:
    """Weigh the runs; bins that a sensor does not see in the nominal prediction are left out."""
    parts = []
    for run in runs:
        measured = referred(run.values, run, campaign.channels)
        for column, channel in campaign.channels.items():
            one = part(run, channel, measured[column], np.isfinite(nominal[run.file, column]))
            if one:
                parts.append(one)
    data = np.concatenate([one.whiten(one.data) for one in parts]) if parts else np.zeros(0)
    return Problem(campaign, tuple(runs), parts, data, executor)


@dataclass(frozen=True)
class Solution:
    """Coefficients of directions, the cost (misfit and priors), misfit alone, and the log of the evidence.

    `deviation` are the coefficients' standard deviations, with the discrepancy as if it were noise.
    """

    coefficients: Floats
    cost: float
    misfit: float
    evidence: float
    deviation: Floats


def solve(residual: Floats, matrix: Floats, directions: Sequence[Direction], start: Floats | None = None) -> Solution:
    """Most likely coefficients x of residual = matrix @ (x - start) within bounds, given their priors.

    The evidence is Laplace's: likelihood at the best x times the share of the prior that the data leave.
    """
    start = np.zeros(len(directions)) if start is None else start
    prior = np.array([one.prior for one in directions])
    rows = np.vstack([matrix, np.diag(1.0 / prior)])
    target = np.concatenate([residual + matrix @ start, np.zeros(len(prior))])
    lower, upper = (np.array([getattr(one, side) for one in directions]) for side in ("lower", "upper"))
    found = lsq_linear(rows, target, (lower, upper)).x if len(prior) else prior
    left = residual - matrix @ (found - start)
    misfit, penalty = float(left @ left), float(((found / prior) ** 2).sum())
    curvature = np.eye(len(prior)) + prior[:, None] * (matrix.T @ matrix) * prior
    evidence = -0.5 * (misfit + penalty + float(np.linalg.slogdet(curvature)[1]))
    deviation = prior * np.sqrt(np.diag(np.linalg.inv(curvature)))
    return Solution(found, misfit + penalty, misfit, evidence, deviation)
