"""Sensor placement: the heights at which a few sensors measure most of every swing."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SensorChoice:
    """Indices of the chosen places, and the worst-case fraction of the largest swing that one of them measures."""

    places: tuple[int, ...]
    share: float


def choose_sensors(departures: Floats, count: int) -> SensorChoice:
    """Choose `count` places of `departures` (cases, places) by greedy selection followed by exchange.

    `departures` are the largest at each place; the fraction is relative to the largest one of that case.
    """
    shares = departures / departures.max(axis=1, keepdims=True)
    chosen: list[int] = []
    for _ in range(count):
        chosen.append(_best(shares, chosen))
    for _ in range(count):
        for k in range(count):
            others = chosen[:k] + chosen[k + 1 :]
            chosen = [*others[:k], _best(shares, others), *others[k:]]
    return SensorChoice(tuple(sorted(chosen)), float(shares[:, chosen].max(axis=1).min()))


def _best(shares: Floats, chosen: Sequence[int]) -> int:
    """The place that improves the worst case most; for equal ones the mean over cases decides."""
    have = shares[:, list(chosen)].max(axis=1, initial=0.0)[:, None]
    with_each = np.maximum(shares, have)
    return int(np.argmax(with_each.min(axis=0) + 1e-3 * with_each.mean(axis=0)))
