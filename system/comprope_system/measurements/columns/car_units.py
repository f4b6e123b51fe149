"""Units of car position and time that are not stated, where only one makes the motion that of a car in its shaft."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..units import TIMES

Floats = NDArray[np.float64]
OUTSIDE = 0.5  # m by which a car may be outside its travel, between buffers
SHORTEST = 0.3  # m of a trip; less is no trip, but noise
SPEEDS = (0.05, 21.0)  # m/s on the average of a trip's middle: creeping to the fastest elevator built
ACCELERATIONS = (0.06, 8.0)  # m/s2, of the same: of a car that creeps to its landing, up to an emergency stop
HARDEST = 3.0  # m/s2 with which a car reaches its speed on half its way; more is no car's
SHARES = (0.2, 0.8)  # of the travel, between which that speed is taken
MARGIN = 0.01  # of the travel at either end that is left out of its duration: creeping and noise
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


@dataclass(frozen=True)
class Course:
    """A car's first travel: average speed [m/s] in its middle, distance [m], and mean acceleration [m/s2] to that speed.

    `measured`: from a measured "position" or "speed".
    """

    speed: float
    travel: float
    acceleration: float
    measured: str = "position"

    def with_unit(self, second: float) -> "Course":
        """The same if the unit of time is as long as `second` [s]."""
        if self.measured == "speed":
            return replace(self, travel=self.travel * second, acceleration=self.acceleration / second)
        return replace(self, speed=self.speed / second, acceleration=self.acceleration / second**2)

    def fits(self, height: float) -> bool:
        """Whether speed and travel are those of a car in a shaft of this height [m]."""
        inside = SHORTEST <= self.travel <= height + 2.0 * OUTSIDE
        return inside and SPEEDS[0] <= self.speed <= fastest(self.travel)

    @property
    def accelerates(self) -> bool:
        """Whether the acceleration is a car's."""
        return ACCELERATIONS[0] <= self.acceleration <= ACCELERATIONS[1]


def course(time: Floats, position: Floats) -> Course | None:
    """The first travel of a car from its positions (n,) [m]; None if it hardly moves."""
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
    speed = float(abs(x[last] - x[before]) / (t[last] - t[before]))
    away = (x > low + MARGIN * travel) & (x < high - MARGIN * travel)
    begin = first - int(np.argmax(np.r_[~away[first::-1], True])) + 1
    end = first + int(np.argmax(np.r_[~away[first:], True])) - 1
    # At constant acceleration the travel takes longer than at that speed throughout, by the time that the car needs to reach it.
    late = float(t[end] - t[begin]) - float(abs(x[end] - x[begin])) / speed
    return Course(speed, travel, speed / late if late > 0.0 else np.inf)


def time_unit(seen: Course, height: float) -> str | None:
    """The only unit of time with which a travel that is none with seconds is a car's; None if none, or several, are.

    Units longer than a second are not guessed: one fits almost any number. The acceleration tells units apart that differ by
    ten: ticks of 0.1 ms read as ms leave a plausible speed, but a hundredth of the acceleration.
    """
    read = {unit: seen.with_unit(size) for unit, size in TIMES.items() if size < 1.0}
    fitting = [unit for unit, one in read.items() if one.fits(height) and one.accelerates]
    return fitting[0] if len(fitting) == 1 else None


def fastest(travel: float) -> float:
    """The highest speed [m/s] at which a car can pass the middle of a travel [m]."""
    return min(SPEEDS[1], (HARDEST * travel) ** 0.5)
