"""A position signal made ready for recovery: its noise and resolution, held samples, spikes, and dense sampling averaged."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from comprope.errors import InputError

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

LEAST_NOISE = 1e-6  # m; lower bound of the noise, for signals that are exact for all practical purposes
FEWEST = 20  # samples from which a motion can be estimated
ACCELERATED = 0.8  # ratio of two estimates of the noise, 1 for white noise, below which one is of the acceleration instead
BIN = 8e-3  # s; denser sampling is averaged to this interval, a fifth of the knots' spacing
TOP_SPEED = 25.0  # m/s; the highest rated speed that the drive accepts: no car moves faster
DIGITS = 9  # decimal digits [m] of a value that matter
GRID = 0.1  # of a step; how far differences may be from multiples of it
COARSEST = 0.05  # m; a signal of larger steps, such as the number of a landing, shows no motion
LONGEST_HELD = 1.0  # s; values held for longer do not show how the car starts and stops
HELD = 1.5  # median number of equal samples in a moving signal from which on its values are held by a slower device
LONG_HOLD = 10.0  # median holds; a value repeated for longer is that of a car at rest
LOCAL = 31  # samples over which the noise is local
JERK = 2.0  # m/s3; a sampling interval at which it matters is too long to tell failures from motion
HARD_STOP = 15.0  # m/s2; deceleration by a safety gear, beyond the 1 g that standards allow on the average
LONG_INTERVAL = 0.05  # s between samples from which on what a safety gear does within it is told from no failure of the sensor
SUSPECT = 8.0  # noise standard deviations from the neighbours, beyond which a sample is looked at
SURE = 5.0  # standard deviations from an extrapolation of the neighbours on one side, within which a sample continues them
DEGREES = (1, 2, 3)  # of polynomials through neighbours on one side: constant speed, acceleration and jerk
IMPACT = 5.0  # m/s; largest change of the speed within a sampling interval, that of a counterweight that falls back a metre
LARGEST_WEIGHTS = 20.0  # root sum of squares of an extrapolation's weights, beyond which it says nothing
REACH = 5  # samples on either side that are looked at; a longer excursion than this is not recognised
CHUNK = 100_000  # samples looked at together, which bounds the memory
ROUNDS = 4  # of leaving out: a sample beside a failure is judged better without it


@dataclass(frozen=True)
class Signal:
    """Positions (n,) [m] at increasing times (n,) [s], all finite; standard deviation of the noise and resolution [m].

    `local_noise` (n,) [m] is above `noise` where the signal is noisier for a while, as by uncertain times of a fast car. `held`
    is the interval [s] between new values of a signal that repeats them, 0 for others.
    """

    time: Floats
    position: Floats
    noise: float
    resolution: float
    local_noise: Floats
    held: float = 0.0

    def of(self, mask: Mask | slice) -> "Signal":
        """Some of the samples."""
        return Signal(self.time[mask], self.position[mask], self.noise, self.resolution, self.local_noise[mask], self.held)

    @property
    def rounded(self) -> bool:
        """Whether the signal has no noise but its rounding."""
        return _only_rounding(self.noise, self.resolution)

    @property
    def interval(self) -> float:
        """Median sampling interval [s]."""
        return float(np.median(np.diff(self.time)))


    @property
    def hidden(self) -> float:
        """Distance [m] that a hard stop within a long sampling interval takes from a steady motion; 0 for dense sampling."""
        return 0.5 * HARD_STOP * self.interval**2 if self.interval >= LONG_INTERVAL else 0.0


def prepare(time: Floats, position: Floats, step: float | None = None) -> Signal:
    """The signal of the finite samples of `position` [m] at `time` [s], and of resolution `step` [m] if it does not show its own.

    Raises `InputError` if times do not increase or fewer than 20 samples are numbers.
    """
    known = np.isfinite(position)
    if time.ndim != 1 or time.shape != position.shape or not np.all(np.isfinite(time)):
        raise InputError("time: a finite number is needed in every row")
    if np.any(np.diff(time) <= 0.0):
        row = int(np.argmax(np.diff(time) <= 0.0)) + 2
        raise InputError(f"time = {time[row - 1]:g} s in row {row}: must be later than the row before")
    if known.sum() < FEWEST:
        raise InputError(f"position: {known.sum()} numbers; at least {FEWEST} are needed to estimate the motion of the car")
    t, x = time[known], position[known]
    step = resolution(x) if step is None else step
    t, x, held = _without_repetitions(t, x, min(step, COARSEST))
    step = resolution(x) if held else step
    if np.median(np.diff(t)) < 0.5 * BIN:
        dense = _signal(t, x, step)
        t, x = _averaged(t, x, spikes(dense))
    return replace(_signal(t, x, step), held=held)


def _signal(time: Floats, position: Floats, step: float) -> Signal:
    size = noise(time, position, step)
    return Signal(time, position, size, step, np.maximum(size, _local_noise(time, position)))


def _local_noise(time: Floats, position: Floats) -> Floats:
    """Standard deviation [m] of the noise around each sample (n,), from third differences; a short event does not show."""
    count = len(time) - 3
    times, values = (np.lib.stride_tricks.sliding_window_view(one, 4) for one in (time, position))
    third, squares = np.zeros(count), np.zeros(count)
    for j in range(4):
        weight = 1.0 / np.prod([times[:, j] - times[:, m] for m in range(4) if m != j], axis=0)
        third, squares = third + weight * (values[:, j] - values[:, 0]), squares + weight**2
    return np.pad(1.4826 * median_filter(np.abs(third) / np.sqrt(squares), LOCAL, mode="nearest"), (1, 2), mode="edge")


def _only_rounding(noise: float, resolution: float) -> bool:
    return noise <= max(resolution / 12.0**0.5, LEAST_NOISE)


def noise(time: Floats, position: Floats, step: float) -> float:
    """Standard deviation [m] of the noise, from the distance of each sample to the line between its neighbours.

    `step` is the resolution [m] of the signal: rounding is noise that does not show at rest.
    """
    before, after = np.diff(time)[:-1], np.diff(time)[1:]
    share = before / (before + after)
    gap = position[1:-1] - (1.0 - share) * position[:-2] - share * position[2:]
    close = before + after <= 3.0 * np.median(before + after)
    scaled = np.abs(gap / np.sqrt(1.0 + share**2 + (1.0 - share) ** 2))[close]
    seen = 1.4826 * float(np.median(scaled))
    # Lines miss an accelerated motion. Differences of successive gaps do not, and their noise is 5**0.5 times that of a sample.
    bent = np.abs(np.diff(gap))[close[1:] & close[:-1]] / 5.0**0.5
    steady = 1.4826 * float(np.median(bent)) if len(bent) else seen
    return max(steady if steady < ACCELERATED * seen else seen, step / 12.0**0.5, LEAST_NOISE)


def resolution(position: Floats) -> float:
    """Smallest difference [m] between two values of a signal that repeats some, otherwise that of its decimal digits.

    Values that are repeated because they are held by a slow device lie on no grid of such steps.
    """
    rounded = np.round(position, DIGITS)
    steps = np.diff(np.unique(rounded))
    if not len(steps):
        return 0.0
    multiples = steps / steps.min()
    if np.any(np.diff(rounded) == 0.0) and np.all(np.abs(multiples - np.round(multiples)) < GRID):
        return float(steps.min())
    digits = next(k for k in range(DIGITS + 1) if k == DIGITS or np.array_equal(np.round(rounded, k), rounded))
    return min(float(steps.min()), float(10.0**-digits))


def _without_repetitions(time: Floats, position: Floats, step: float) -> tuple[Floats, Floats, float]:
    """The samples at which a held signal changes, repeated at its interval where it rests; and that interval, 0 if not held.

    Only runs of equal values that end in a jump by more than three steps of the resolution count: a coarse signal of a slow
    car repeats values too, but changes by one step at a time.
    """
    first = np.concatenate(([0], np.flatnonzero(np.diff(position)) + 1))
    length = np.diff(np.append(first, len(position)))
    jumps = np.abs(np.diff(position[first])) > 3.5 * step
    inner = length[1:-1][jumps[:-1] & jumps[1:]]
    if len(inner) < FEWEST // 2 or (count := float(np.median(inner))) < HELD:
        return time, position, 0.0
    since = np.arange(len(position)) - np.repeat(first, length)
    rests = np.repeat(length, length) > LONG_HOLD * count
    kept = (since == 0) | (rests & (since % round(count) == 0))
    return time[kept], position[kept], float(np.median(np.diff(time))) * round(count)


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


def _averaged(time: Floats, position: Floats, left_out: Mask) -> tuple[Floats, Floats]:
    """Means over intervals of BIN, free of the curvature within an interval."""
    time, position = time[~left_out], position[~left_out]
    place = ((time - time[0]) / BIN).astype(np.int64)
    bins, at = np.unique(place, return_index=True)
    count = np.diff(np.append(at, len(time)))
    t, x = np.add.reduceat(time, at) / count, np.add.reduceat(position - position[0], at) / count + position[0]
    # The mean of a parabola over an interval exceeds its middle by a 24th of its second difference.
    bend = np.zeros(len(x))
    even = (np.diff(bins)[1:] == 1) & (np.diff(bins)[:-1] == 1)
    bend[1:-1] = np.where(even, x[:-2] - 2.0 * x[1:-1] + x[2:], 0.0)
    return t, x - bend / 24.0


def no_motion(signal: Signal, left_out: Mask) -> str | None:
    """A sentence about a signal of large steps or a jump that no car makes, samples `left_out` aside; None if there is none."""
    if signal.resolution > COARSEST:
        return f"position changes in steps of {signal.resolution:.4g} m: at most {COARSEST:g} m is accepted"
    if signal.held > LONGEST_HELD:
        return f"position holds its values for {signal.held:.3g} s: at most {LONGEST_HELD:g} s is accepted"
    t, x = signal.time[~left_out], signal.position[~left_out]
    steps, times = np.abs(np.diff(x)), np.diff(t)
    excess = steps - TOP_SPEED * times - 10.0 * signal.local_noise[~left_out][1:] - signal.resolution
    worst = int(np.argmax(excess))
    if excess[worst] <= 0.0:
        return None
    speed = steps[worst] / times[worst]
    if np.median(steps / times) > TOP_SPEED:
        usual = f"position changes by {np.median(steps / times):.4g} m/s"
        return f"{usual}: at most {TOP_SPEED:g} m/s is accepted; its unit is probably mm"
    where = f"from {x[worst]:.6g} m to {x[worst + 1]:.6g} m between time = {t[worst]:.6g} s and {t[worst + 1]:.6g} s"
    return f"position jumps {where}: at most {TOP_SPEED:g} m/s is accepted, this is {speed:.4g} m/s; leave such cells empty"
