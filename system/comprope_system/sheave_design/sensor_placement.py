"""Sensor placement: the heights at which a few sensors measure most of every swing."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SensorChoice:
    """Chosen places as indices, and the share of the largest swing that the best of them measures, on the worst occasion."""

    places: tuple[int, ...]
    share: float


def choose_sensors(departures: Floats, count: int) -> SensorChoice:
    """The `count` places at which most of the motion of every occasion is measured: greedy choice, then exchange.

    `departures` (occasions, places) are the largest at each place; the share is over the largest anywhere on that occasion.
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
    """The place that helps the worst occasion most, by the mean where several do."""
    have = shares[:, list(chosen)].max(axis=1, initial=0.0)[:, None]
    with_each = np.maximum(shares, have)
    return int(np.argmax(with_each.min(axis=0) + 1e-3 * with_each.mean(axis=0)))
