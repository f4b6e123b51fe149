"""Free-form trips: accelerations at equal intervals of the travel time, linear in between.

All trips have the same shape; the duration of each follows from the limits of speed, acceleration and jerk. With fractions
s_k of the largest acceleration A at the times k T / 20, and the largest speed c_v, the largest jerk c_j and the distance c_x of
the shape (for A = 1, T = 1),

    distance = A T^2 c_x   speed = A T c_v   jerk = A c_j / T
"""

from dataclasses import dataclass
from functools import cached_property

from ...kernels.kernel_linking import uncompiled
from ..kernels.arguments import (
    ACCELERATIONS,
    BEGIN,
    DISTANCES,
    DURATION,
    END,
    FREE,
    INTEGRALS,
    INTERVALS,
    ORIGIN,
    SPEEDS,
    TRIP,
)
from ..kernels.reference import free_curve
from ..parameters import Curve, Profile
from .s_curve import TrajectoryPoint

Shape = tuple[float, ...]
_KERNELS = uncompiled(free_curve)


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
    def numbers(self) -> tuple[float, ...]:
        """The trip as kernels have it."""
        trip = [0.0] * TRIP
        trip[BEGIN], trip[ORIGIN], trip[END] = self.start_time, self.origin, self.destination
        trip[DURATION], trip[FREE] = self.duration, 1.0
        trip[ACCELERATIONS:SPEEDS] = map(float, self.shape)
        _KERNELS.set_knots(trip)
        return tuple(trip)

    @property
    def knots(self) -> tuple[Shape, Shape, Shape, Shape]:
        """At each knot: acceleration, velocity, distance from the origin and its integral, in SI units, up positive."""
        a, v, x, integral = (
            self.numbers[first : first + INTERVALS + 1] for first in (ACCELERATIONS, SPEEDS, DISTANCES, INTEGRALS)
        )
        return a, v, x, integral

    def at(self, time: float) -> TrajectoryPoint:
        """The reference at `time` [s]; at rest before the trip begins and after it ends."""
        return TrajectoryPoint(*_KERNELS.free_curve_at(self.numbers, time))

    def displacement_integral(self, time: float) -> float:
        """The integral of the distance from the origin over time, up to `time` [m s]."""
        return float(_KERNELS.free_curve_integral(self.numbers, time))


def plan_free_curve(curve: Curve, profile: Profile, origin: float, destination: float, start_time: float) -> FreeCurve:
    """The fastest trip of the curve's shape within the limits of `profile`, from rest to rest between two heights [m]."""
    shape: Shape = (0.0, *(getattr(curve, name) for name in Curve.model_fields), 0.0)
    distance = abs(destination - origin)
    duration = _KERNELS.least_duration(shape, 0, distance, profile.speed, profile.acceleration, profile.jerk)
    return FreeCurve(start_time, origin, destination, duration, shape)
