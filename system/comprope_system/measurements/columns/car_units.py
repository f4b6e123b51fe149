"""Units of car position and time that are not stated, where only one makes the motion that of a car in its shaft."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..units import TIMES

Floats = NDArray[np.float64]
OUTSIDE = 0.5  # m by which a car may be outside its travel, between buffers
SHORTEST = 0.3  # m of a trip; less is no trip, but noise
SPEEDS = (0.05, 21.0)  # m/s on the average of a trip's middle: creeping to the fastest elevator built
HARDEST = 3.0  # m/s2 with which a car reaches its speed on half its way; more is no car's
SHARES = (0.2, 0.8)  # of the travel, between which that speed is taken
GUESSED_LENGTHS = ("mm", "cm", "ft", "in")


def fits_shaft(position: Floats, height: float) -> bool:
    """Whether positions [m] lie in a shaft of this height [m], but for single samples."""
    low, high = np.nanpercentile(position, (1.0, 99.0))
    return bool(low > -OUTSIDE and high < height + OUTSIDE)


def length_unit(position: Floats, height: float, units: Mapping[str, float]) -> str | None:
    """The only unit in which positions that are too large for metres lie in the shaft; None if none, or several, do."""
    low, high = np.nanpercentile(position, (1.0, 99.0))
    if high - low <= height + 2.0 * OUTSIDE:
        return None
    fitting = [one for one in GUESSED_LENGTHS if fits_shaft(position * units[one], height)]
    # The largest unit of those that fit: in a smaller one the car would hardly have moved.
    moved = [one for one in fitting if (high - low) * units[one] > SHORTEST]
    return moved[0] if len(moved) == 1 else None


def middle_speed(time: Floats, position: Floats) -> tuple[float, float] | None:
    """Average speed [m/s] in the middle of the first travel, and the travel [m]; None if the car hardly moves."""
    known = np.isfinite(time) & np.isfinite(position)
    t, x = time[known], position[known]
    if len(t) < 10:
        return None
    low, high = np.percentile(x, (1.0, 99.0))
    travel = float(high - low)
    inside = (x > low + SHARES[0] * travel) & (x < low + SHARES[1] * travel)
    if travel < SHORTEST or not inside.any():
        return None
    first = int(np.argmax(inside))
    last = min(first + int(np.argmax(np.r_[~inside[first:], True])), len(t) - 1)
    before = max(first - 1, 0)
    return float(abs(x[last] - x[before]) / (t[last] - t[before])), travel


def time_unit(speed: float, travel: float) -> str | None:
    """The only unit of time with which a speed [m/s] that is too low with seconds is a car's; None if none, or several, are.

    Units longer than a second are not guessed: one fits almost any number.
    """
    fitting = [unit for unit, size in TIMES.items() if size < 1.0 and SPEEDS[0] <= speed / size <= fastest(travel)]
    return fitting[0] if len(fitting) == 1 else None


def fastest(travel: float) -> float:
    """The highest speed [m/s] at which a car can pass the middle of a travel [m]."""
    return min(SPEEDS[1], (HARDEST * travel) ** 0.5)
