"""Where to look at the rope: the heights at which a few sensors see most of every swing."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Choice:
    """Chosen places as indices, and the share of the largest swing that the best of them sees, on the worst occasion."""

    places: tuple[int, ...]
    share: float


def choose(seen: Floats, count: int) -> Choice:
    """The `count` places of `seen` (occasions, places) that see most of every occasion: one after the other, then exchanged.

    `seen` are the largest departures at each place; the share is over the largest anywhere on that occasion.
    """
    shares = seen / seen.max(axis=1, keepdims=True)
    chosen: list[int] = []
    for _ in range(count):
        chosen.append(_best(shares, chosen))
    for _ in range(count):
        for k in range(count):
            others = chosen[:k] + chosen[k + 1 :]
            chosen = [*others[:k], _best(shares, others), *others[k:]]
    return Choice(tuple(sorted(chosen)), float(shares[:, chosen].max(axis=1).min()))


def _best(shares: Floats, chosen: Sequence[int]) -> int:
    """The place that helps the worst occasion most, by the mean where several do."""
    have = shares[:, list(chosen)].max(axis=1, initial=0.0)[:, None]
    with_each = np.maximum(shares, have)
    return int(np.argmax(with_each.min(axis=0) + 1e-3 * with_each.mean(axis=0)))
