"""Noise and resolution of a signal, from the signal itself."""

import numpy as np
from scipy.ndimage import median_filter

from .position_signal import LEAST_NOISE, Floats

ACCELERATED = 0.8  # ratio of two estimates of the noise, 1 for white noise, below which one is of the acceleration instead
DIGITS = 9  # decimal digits [m] of a value that matter
GRID = 0.1  # of a step; how far differences may be from multiples of it
LOCAL = 31  # samples over which the noise is local


def local_noise(time: Floats, position: Floats) -> Floats:
    """Standard deviation [m] of the noise around each sample (n,), from third differences; a short event does not show."""
    count = len(time) - 3
    times, values = (np.lib.stride_tricks.sliding_window_view(one, 4) for one in (time, position))
    third, squares = np.zeros(count), np.zeros(count)
    for j in range(4):
        weight = 1.0 / np.prod([times[:, j] - times[:, m] for m in range(4) if m != j], axis=0)
        third, squares = third + weight * (values[:, j] - values[:, 0]), squares + weight**2
    return np.pad(1.4826 * median_filter(np.abs(third) / np.sqrt(squares), LOCAL, mode="nearest"), (1, 2), mode="edge")


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
