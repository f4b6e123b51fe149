"""Search with the reduced model: quasi-random samples of the parameters of a family, then local optimisation of the best."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.stats import qmc

from comprope.drive.parameters import Drive

from ...vibration.reduced_model.swing import Swing
from .profile_families import SHARES, Route, drive_in_time, share_names

Floats = NDArray[np.float64]
Evaluate = Callable[[Drive], list[Swing]]
Cost = Callable[[list[Swing]], float]

SAMPLES, REFINED, REFINEMENT_STEPS = 64, 2, 60
INFEASIBLE = 1e9
SAME_SHARE = 0.06  # shares all nearer than that are the same candidate
SAME_COST = 1e-2  # of a cost: nearer than that too, however far the shares: a short trip never reaches its limit of speed


@dataclass(frozen=True)
class Candidate:
    """A family with its parameters, the resulting drive, and its swings and cost with the reduced model."""

    kind: str
    shares: Mapping[str, float]
    drive: Drive
    swings: list[Swing]
    cost: float


@dataclass
class Search:
    """A search over trips of a drive on `routes` that take `time` [s] in total, evaluated by `evaluate` and `cost`."""

    drive: Drive
    routes: list[Route]
    time: float
    evaluate: Evaluate
    cost: Cost
    tried: dict[tuple[float, ...], Candidate] = field(default_factory=dict)

    def best(self, kind: str, starts: Sequence[Mapping[str, float]] = (), count: int = 1) -> list[Candidate]:
        """The best distinct candidates of a family, best first; empty if no trip of the family is so fast.

        `starts` are additional initial parameters.
        """
        self.tried = {}
        keys = share_names(kind)
        first = [np.array([start.get(key, self._neutral_share(key)) for key in keys]) for start in starts]
        for point in [*first, *_samples(keys)]:
            self._evaluate_shares(kind, keys, point)
        for one in _distinct(self.tried.values(), keys, REFINED):
            self._refine(kind, keys, np.array([one.shares[key] for key in keys]))
        return _distinct(self.tried.values(), keys, count)

    def _neutral_share(self, key: str) -> float:
        """Parameter value with the smallest change of the profile."""
        return SHARES[key][0] if key == "smoothing" else 1.0

    def _evaluate_shares(self, kind: str, keys: tuple[str, ...], point: Floats) -> float:
        low, high = np.array([SHARES[key] for key in keys]).T
        outside = float(np.maximum(low - point, 0.0).sum() + np.maximum(point - high, 0.0).sum())
        shares = dict(zip(keys, np.clip(point, low, high).tolist(), strict=True))
        made = drive_in_time(self.drive, kind, shares, self.routes, self.time)
        if made is None:
            return INFEASIBLE
        swings = self.evaluate(made)
        cost = self.cost(swings)
        self.tried[tuple(shares.values())] = Candidate(kind, shares, made, swings, cost)
        return cost * (1.0 + outside)

    def _refine(self, kind: str, keys: tuple[str, ...], point: Floats) -> None:
        low, high = np.array([SHARES[key] for key in keys]).T
        simplex = np.vstack([point, point + 0.08 * np.diag(np.where(point > 0.5 * (low + high), low - high, high - low))])
        minimize(
            lambda at: self._evaluate_shares(kind, keys, at), point, method="Nelder-Mead",
            options={"maxfev": REFINEMENT_STEPS, "initial_simplex": simplex, "xatol": 1e-3, "fatol": 1e-4},
        )  # fmt: skip


def _samples(keys: tuple[str, ...]) -> Floats:
    low, high = np.array([SHARES[key] for key in keys]).T
    points = qmc.Sobol(len(keys), seed=0).random(SAMPLES)
    return np.asarray(low + (high - low) * points)


def _distinct(candidates: Iterable[Candidate], keys: tuple[str, ...], count: int) -> list[Candidate]:
    """The candidates of lowest cost that differ from each other in a parameter and in cost."""
    found: list[Candidate] = []
    for one in sorted(candidates, key=lambda each: each.cost):
        if all(
            any(abs(one.shares[key] - other.shares[key]) > SAME_SHARE for key in keys)
            and one.cost > (1.0 + SAME_COST) * other.cost
            for other in found
        ):
            found.append(one)
        if len(found) == count:
            break
    return found
