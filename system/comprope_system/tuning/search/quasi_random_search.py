"""Search with the reduced model: quasi-random samples of the parameters of a family, then local optimisation of the best."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.stats import qmc

from comprope.drive.parameters import Drive

from ...reduced_model.swing import Swing
from .profile_families import SHARES, Way, drive_in_time, names

Floats = NDArray[np.float64]
Judge = Callable[[Drive], list[Swing]]
Cost = Callable[[list[Swing]], float]

SAMPLES, POLISHED, STEPS = 64, 2, 60
INFEASIBLE = 1e9
SAME = 0.06  # shares all nearer than that are the same candidate
ALIKE = 1e-2  # of a cost: nearer than that too, however far the shares: a short trip never reaches its limit of speed


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
    """A search over trips of a drive on `ways` that take `time` [s] in total, evaluated by `judge` and `cost`."""

    drive: Drive
    ways: list[Way]
    time: float
    judge: Judge
    cost: Cost
    tried: dict[tuple[float, ...], Candidate] = field(default_factory=dict)

    def best(self, kind: str, starts: Sequence[Mapping[str, float]] = (), count: int = 1) -> list[Candidate]:
        """The best distinct candidates of a family, best first; empty if no trip of the family is so fast.

        `starts` are additional initial parameters.
        """
        self.tried = {}
        keys = names(kind)
        first = [np.array([start.get(key, self._still(key)) for key in keys]) for start in starts]
        for point in [*first, *_samples(keys)]:
            self._try(kind, keys, point)
        for one in _unlike(self.tried.values(), keys, POLISHED):
            self._polish(kind, keys, np.array([one.shares[key] for key in keys]))
        return _unlike(self.tried.values(), keys, count)

    def _still(self, key: str) -> float:
        """Parameter value with the smallest change of the profile."""
        return SHARES[key][0] if key == "smoothing" else 1.0

    def _try(self, kind: str, keys: tuple[str, ...], point: Floats) -> float:
        low, high = np.array([SHARES[key] for key in keys]).T
        outside = float(np.maximum(low - point, 0.0).sum() + np.maximum(point - high, 0.0).sum())
        shares = dict(zip(keys, np.clip(point, low, high).tolist(), strict=True))
        made = drive_in_time(self.drive, kind, shares, self.ways, self.time)
        if made is None:
            return INFEASIBLE
        swings = self.judge(made)
        cost = self.cost(swings)
        self.tried[tuple(shares.values())] = Candidate(kind, shares, made, swings, cost)
        return cost * (1.0 + outside)

    def _polish(self, kind: str, keys: tuple[str, ...], point: Floats) -> None:
        low, high = np.array([SHARES[key] for key in keys]).T
        simplex = np.vstack([point, point + 0.08 * np.diag(np.where(point > 0.5 * (low + high), low - high, high - low))])
        minimize(
            lambda at: self._try(kind, keys, at), point, method="Nelder-Mead",
            options={"maxfev": STEPS, "initial_simplex": simplex, "xatol": 1e-3, "fatol": 1e-4},
        )  # fmt: skip


def _samples(keys: tuple[str, ...]) -> Floats:
    low, high = np.array([SHARES[key] for key in keys]).T
    points = qmc.Sobol(len(keys), seed=0).random(SAMPLES)
    return np.asarray(low + (high - low) * points)


def _unlike(candidates: Iterable[Candidate], keys: tuple[str, ...], count: int) -> list[Candidate]:
    """The candidates of lowest cost that differ from each other in a parameter and in cost."""
    found: list[Candidate] = []
    for one in sorted(candidates, key=lambda each: each.cost):
        if all(
            any(abs(one.shares[key] - other.shares[key]) > SAME for key in keys) and one.cost > (1.0 + ALIKE) * other.cost
            for other in found
        ):
            found.append(one)
        if len(found) == count:
            break
    return found
