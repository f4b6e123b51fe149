"""Samples that are failures of the sensor: they continue the motion on neither side."""

import numpy as np
from scipy.ndimage import median_filter

from .position_signal import Floats, Mask, Signal

TOP_SPEED = 25.0  # m/s; the highest rated speed that the drive accepts: no car moves faster
JERK = 2.0  # m/s3; a sampling interval at which it matters is too long to tell failures from motion
SUSPECT = 8.0  # noise standard deviations from the neighbours, beyond which a sample is looked at
SURE = 5.0  # standard deviations from an extrapolation of the neighbours on one side, within which a sample continues them
DEGREES = (1, 2, 3)  # of polynomials through neighbours on one side: constant speed, acceleration and jerk
IMPACT = 5.0  # m/s; largest change of the speed within a sampling interval, that of a counterweight that falls back a metre
LARGEST_WEIGHTS = 20.0  # root sum of squares of an extrapolation's weights, beyond which it says nothing
REACH = 5  # samples on either side that are looked at; a longer excursion than this is not recognised
CHUNK = 100_000  # samples looked at together, which bounds the memory
ROUNDS = 4  # of leaving out: a sample beside a failure is judged better without it


def spikes(signal: Signal) -> Mask:
    """Samples that continue the motion neither from the left nor from the right: failures of the sensor, no motion.

    A kink or a jump of the acceleration continues from one side at least. In a signal without noise an impact that ends
    between two samples shows too, so that only what exceeds it is a failure.
    """
    found = []
    for start in range(0, len(signal.time), CHUNK):
        before = min(start, 4 * REACH)
        found.append(_spikes(signal.of(slice(start - before, start + CHUNK + 4 * REACH)))[before : before + CHUNK])
    return np.concatenate(found)


def _spikes(signal: Signal) -> Mask:
    time, position, noise, interval = signal.time, signal.position, signal.local_noise, signal.interval
    least = max(IMPACT * interval if signal.rounded else 0.0, JERK * interval**3, signal.hidden)
    good = ~_far_away(time, position, noise)
    for _ in range(ROUNDS):
        at = np.flatnonzero(good)
        t, x, s = time[at], position[at], noise[at]
        suspect = (distance_to_neighbours(t, x) > SUSPECT * s) & _off_cubic(t, x, s)
        found = [k for k in np.flatnonzero(suspect) if _continues_neither(t, x, int(k), float(s[k]), (interval, least))]
        if not found:
            break
        good[at[found]] = False
    return ~good


def _far_away(time: Floats, position: Floats, noise: Floats) -> Mask:
    """Samples farther from the median of their neighbours than any car travels meanwhile."""
    index, last = np.arange(len(time)), len(time) - 1
    reach = np.maximum(time[np.minimum(index + REACH, last)] - time, time - time[np.maximum(index - REACH, 0)])
    middle = median_filter(position, 2 * REACH + 1, mode="nearest")
    return np.asarray(np.abs(position - middle) > TOP_SPEED * reach + SUSPECT * noise)


def _off_cubic(time: Floats, position: Floats, noise: Floats) -> Mask:
    """Samples far from the cubic through two neighbours on either side: unlike a line, it follows an accelerated motion."""
    off = np.ones(len(time), bool)
    near, offsets = slice(2, -2), (-2, -1, 1, 2)
    nodes = [np.roll(time, -j)[near] for j in offsets]
    reached, squares = np.zeros(max(len(time) - 4, 0)), np.ones(max(len(time) - 4, 0))
    for j, node in zip(offsets, nodes, strict=True):
        others = [other for other in nodes if other is not node]
        weight = np.prod([(time[near] - other) / (node - other) for other in others], axis=0)
        reached, squares = reached + weight * np.roll(position, -j)[near], squares + weight**2
    off[near] = np.abs(position[near] - reached) > SURE * noise[near] * np.sqrt(squares)
    return off


def _continues_neither(time: Floats, position: Floats, k: int, noise: float, scale: tuple[float, float]) -> bool:
    """Whether sample k is far from every line, parabola and cubic through its neighbours on either side that has some.

    `scale` are the sampling interval [s] and the least distance [m] that is far.
    """
    interval, least = scale
    sides = [np.arange(k - 1, max(k - 2 * REACH, 0) - 1, -1), np.arange(k + 1, min(k + 2 * REACH, len(time) - 1) + 1)]
    for side in (one for one in sides if len(one) >= DEGREES[-1] + 1):
        apart = _apart(time[side], 0.5 * interval)
        for degree in DEGREES:
            nodes = side[apart[: degree + 1]]
            weights = _extrapolation(time[nodes], time[k])
            size = float(np.sqrt(1.0 + weights @ weights))
            if size <= LARGEST_WEIGHTS and abs(position[k] - weights @ position[nodes]) <= max(SURE * noise * size, least):
                return False
    return True


def _apart(times: Floats, distance: float) -> list[int]:
    """Indices of times that are at least `distance` apart: points close together determine no slope."""
    chosen = [0]
    for j in range(1, len(times)):
        if abs(times[j] - times[chosen[-1]]) >= distance:
            chosen.append(j)
    return chosen


def _extrapolation(nodes: Floats, time: float) -> Floats:
    """Weights (n,) of the values at `nodes` (n,) in the value at `time` of the polynomial through them."""
    others = [np.delete(nodes, j) for j in range(len(nodes))]
    return np.array([np.prod((time - other) / (node - other)) for node, other in zip(nodes, others, strict=True)])


def distance_to_neighbours(time: Floats, position: Floats) -> Floats:
    """Distance (n,) [m] of each sample from the median of the lines between pairs of neighbours, one to five samples away."""
    index = np.arange(len(time))
    lines = []
    for reach in range(1, REACH + 1):
        left, right = np.clip(index - reach, 0, None), np.clip(index + reach, None, len(time) - 1)
        share = (time - time[left]) / np.maximum(time[right] - time[left], 1e-9)
        lines.append(position[left] + share * (position[right] - position[left]))
    return np.asarray(np.abs(position - np.median(lines, axis=0)))
