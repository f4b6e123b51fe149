"""When the car moves and when it rests, found in its position signal."""

import numpy as np
from numpy.typing import NDArray

from .signal.local_misfit import TYPICAL
from .signal.position_signal import Signal

BLOCK = 0.2  # s over which positions are averaged
FEWEST_IN_BLOCK = 4  # samples
SLOW = 5  # blocks over which creeping shows that is too slow to show from one block to the next
SURE = 6.0  # standard errors of a difference that noise does not reach
MEDIAN = 1.25  # standard deviation of a median over that of a mean
AT_REST = 0.1  # quantile of the changes from block to block at which the car rests, in a record with a fifth of its time at rest
HALF_OF_REST = 0.6745  # median of the absolute value of a normally distributed change, in standard deviations
LEVEL = 0.05  # s over which the level at rest is taken
SHORTEST_REST = 1.0  # s; a shorter stop belongs to the motion


def motion_spans(signal: Signal) -> list[tuple[float, float]]:
    """First and last time [s] of each motion, seen beyond the noise."""
    time = signal.time
    width = max(BLOCK, FEWEST_IN_BLOCK * signal.interval)
    place = ((time - time[0]) / width).astype(np.int64)
    _, at = np.unique(place, return_index=True)
    count = np.diff(np.append(at, len(time)))
    mean = np.array([np.median(part) for part in np.split(signal.position, at[1:])])
    error = _error(signal, mean, count)
    moving = _moving(mean, error, signal.resolution)
    edges = np.append(time[at], time[-1])
    spans: list[tuple[float, float]] = []
    for first, last in _runs(moving):
        start = _departure(signal, float(edges[max(first - 1, 0)]), float(edges[first + 1]))
        stop = _departure(signal, -float(edges[min(last + 1, len(edges) - 1)]), -float(edges[last - 1]), -1)
        if spans and start - spans[-1][1] < SHORTEST_REST:
            start = spans.pop()[0]
        spans.append((start, stop))
    return spans


def _error(signal: Signal, mean: NDArray[np.float64], count: NDArray[np.int_]) -> NDArray[np.float64]:
    """Standard deviation (n,) [m] of each block's position, from the noise or from blocks at rest if the noise is correlated."""
    white = MEDIAN * signal.noise / np.sqrt(count)
    if signal.rounded or len(mean) < 2:
        return white
    changes = np.abs(np.diff(mean)) / np.hypot(white[1:], white[:-1])
    usual = float(np.quantile(changes, AT_REST)) / HALF_OF_REST
    return white * float(np.clip(usual, 1.0, TYPICAL))


def _departure(signal: Signal, rest: float, moving: float, direction: int = 1) -> float:
    """Time [s] at which the position leaves its level at `rest` for good, before `moving`; `direction` -1 runs back in time."""
    time, position = direction * signal.time[::direction], signal.position[::direction]
    inside = slice(*np.searchsorted(time, (rest, moving)))
    t, x = time[inside], position[inside]
    if len(t) < FEWEST_IN_BLOCK:
        return direction * rest
    level = float(np.median(x[t <= t[0] + LEVEL]))
    near = np.flatnonzero(np.abs(x - level) <= SURE * signal.noise + signal.resolution)
    return direction * float(t[near[-1]] if len(near) else rest)


def _moving(mean: NDArray[np.float64], error: NDArray[np.float64], resolution: float) -> NDArray[np.bool_]:
    """Blocks (n,) in which the car moves, seen from each one's neighbour or, if slow, over several blocks."""
    moving = np.zeros(len(mean), bool)
    for lag in (1, SLOW):
        if lag >= len(mean):
            continue
        differs = np.abs(mean[lag:] - mean[:-lag]) > SURE * np.hypot(error[lag:], error[:-lag]) + resolution
        if lag > 1:
            seen = np.convolve(moving, np.ones(lag + 1), "valid") > 0
            differs &= ~seen
        for shift in range(lag + 1):
            moving[shift : shift + len(differs)] |= differs
    return moving


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First index and index after the last of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(np.int8), [0]))))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
