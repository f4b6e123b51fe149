"""Free-form trips: accelerations at equal intervals of the travel time, linear in between.

All trips have the same shape; the duration of each follows from the limits of speed, acceleration and jerk. With fractions
s_k of the largest acceleration A at the times k T / 20, and the largest speed c_v, the largest jerk c_j and the distance c_x of
the shape (for A = 1, T = 1),

    distance = A T^2 c_x   speed = A T c_v   jerk = A c_j / T
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise

from ..parameters import INTERVALS, Curve, Profile
from .s_curve import TrajectoryPoint

Shape = tuple[float, ...]


@dataclass(frozen=True)
class FreeCurve:
    """One trip: begins at `start_time` [s] at `origin` [m], takes `duration` [s] to `destination` [m].

    `shape` (INTERVALS + 1,) holds the accelerations over the largest one, at equal parts of the duration.
    """

    start_time: float
    origin: float
    destination: float
    duration: float
    shape: Shape

    @property
    def end_time(self) -> float:
        """When the reference is at rest at the destination [s]."""
        return self.start_time + self.duration

    @cached_property
    def knots(self) -> tuple[Shape, Shape, Shape, Shape]:
        """At each knot: acceleration, velocity, distance from the origin and its integral, in SI units, up positive."""
        dt, distance = self.duration / INTERVALS, self.destination - self.origin
        most = distance / (self.duration**2 * unit_distance(self.shape)) if distance else 0.0
        a = tuple(most * one for one in self.shape)
        v = _cumulative_sums(dt * (b + c) / 2.0 for b, c in pairwise(a))
        x = _cumulative_sums(dt * u + dt**2 * (2.0 * b + c) / 6.0 for u, (b, c) in zip(v, pairwise(a), strict=False))
        integral = _cumulative_sums(
            dt * y + dt**2 * u / 2.0 + dt**3 * (3.0 * b + c) / 24.0 for y, u, (b, c) in zip(x, v, pairwise(a), strict=False)
        )
        return a, v, x, integral

    def at(self, time: float) -> TrajectoryPoint:
        """The reference at `time` [s]; at rest before the trip begins and after it ends."""
        if time >= self.end_time:
            return TrajectoryPoint(self.destination)
        if time <= self.start_time:
            return TrajectoryPoint(self.origin)
        k, t, j = self._interval_at(time)
        a, v, x, _ = (values[k] for values in self.knots)
        displacement = x + v * t + a * t**2 / 2.0 + j * t**3 / 6.0
        return TrajectoryPoint(self.origin + displacement, v + a * t + j * t**2 / 2.0, a + j * t, j)

    def displacement_integral(self, time: float) -> float:
        """The integral of the distance from the origin over time, up to `time` [m s]."""
        over = max(time - self.end_time, 0.0) * (self.destination - self.origin)
        if time <= self.start_time:
            return 0.0
        k, t, j = self._interval_at(min(time, self.end_time))
        a, v, x, integral = (values[k] for values in self.knots)
        return over + integral + x * t + v * t**2 / 2.0 + a * t**3 / 6.0 + j * t**4 / 24.0

    def _interval_at(self, time: float) -> tuple[int, float, float]:
        """Index of the interval at a time, time since its begin [s], and jerk in it [m/s3]."""
        dt, a = self.duration / INTERVALS, self.knots[0]
        k = min(int((time - self.start_time) / dt), INTERVALS - 1)
        return k, time - self.start_time - k * dt, (a[k + 1] - a[k]) / dt


def plan_free_curve(curve: Curve, profile: Profile, origin: float, destination: float, start_time: float) -> FreeCurve:
    """The fastest trip of the curve's shape within the limits of `profile`, from rest to rest between two heights [m]."""
    shape, distance = acceleration_shape(curve), abs(destination - origin)
    return FreeCurve(start_time, origin, destination, _least_duration(shape, profile, distance), shape)


def acceleration_shape(curve: Curve) -> Shape:
    """The relative accelerations at all knots, including the zeros at both ends."""
    return (0.0, *(getattr(curve, name) for name in Curve.model_fields), 0.0)


def unit_distance(shape: Shape) -> float:
    """The distance of a shape for unit largest acceleration and unit duration."""
    speeds = _unit_speeds(shape)
    return sum((u + (2.0 * b + c) / 6.0 / INTERVALS) / INTERVALS for u, (b, c) in zip(speeds, pairwise(shape), strict=False))


def _least_duration(shape: Shape, profile: Profile, distance: float) -> float:
    """The least time [s] in which the shape covers the distance [m] within the limits."""
    unit = unit_distance(shape)
    top, jerk = _peak_speed(shape), INTERVALS * max(abs(b - a) for a, b in pairwise(shape))
    times = (
        (distance * max(map(abs, shape)) / (unit * profile.acceleration)) ** 0.5,
        distance * top / (unit * profile.speed),
        (distance * jerk / (unit * profile.jerk)) ** (1.0 / 3.0),
    )
    return max(times)


def _peak_speed(shape: Shape) -> float:
    """The largest speed for unit largest acceleration and duration, also where it is between two knots."""
    between = (
        u + b**2 / (b - c) / 2.0 / INTERVALS
        for u, (b, c) in zip(_unit_speeds(shape), pairwise(shape), strict=False)
        if b > 0.0 > c
    )
    return max(*_unit_speeds(shape), *between)


def _unit_speeds(shape: Shape) -> Shape:
    return _cumulative_sums((b + c) / 2.0 / INTERVALS for b, c in pairwise(shape))


def _cumulative_sums(parts: Iterable[float]) -> Shape:
    """Running sums from zero."""
    return tuple(accumulate(parts, initial=0.0))
