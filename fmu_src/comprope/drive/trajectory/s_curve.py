"""Jerk-limited trips from rest to rest, in closed form.

A trip has seven phases: the jerk lasts `ramp`, the full acceleration `plateau`, the jerk again
`ramp`, the full speed `cruise`, and then the same in reverse. Short trips have no cruise, shorter
ones no plateau either. The second half is computed as the mirror image of the first, so that
a trip ends exactly at its destination.
"""

from dataclasses import dataclass
from functools import cached_property

from ...kernels.kernel_linking import uncompiled
from ..kernels.arguments import CRUISE, JERK, PLATEAU, RAMP, TRIP
from ..kernels.reference import s_curve
from ..parameters import Profile

_KERNELS = uncompiled(s_curve)


@dataclass(frozen=True)
class TrajectoryPoint:
    """State of the reference: position [m], velocity [m/s], acceleration [m/s2] and jerk [m/s3], up positive."""

    position: float
    velocity: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0


@dataclass(frozen=True)
class SCurve:
    """One trip: begins at `start_time` [s] at `origin` [m], ends at `destination` [m].

    `jerk` [m/s3] is positive for a trip up; `ramp`, `plateau`, `cruise` [s] are the phases' durations.
    """

    start_time: float
    origin: float
    destination: float
    jerk: float
    ramp: float
    plateau: float
    cruise: float

    @property
    def duration(self) -> float:
        """Time [s] from rest to rest: 4 ramps, 2 plateaus and the cruise."""
        return 4.0 * self.ramp + 2.0 * self.plateau + self.cruise

    @property
    def end_time(self) -> float:
        """When the reference is at rest at the destination [s]."""
        return self.start_time + self.duration

    @cached_property
    def numbers(self) -> tuple[float, ...]:
        """The trip as kernels have it, up to its shaping."""
        return (
            self.start_time, self.origin, self.destination, self.duration, self.jerk, self.ramp, self.plateau, self.cruise, 0.0,
        )  # fmt: skip

    def at(self, time: float) -> TrajectoryPoint:
        """The reference at `time` [s]; at rest before the trip begins and after it ends."""
        return TrajectoryPoint(*_KERNELS.s_curve_at(self.numbers, time))

    def displacement_integral(self, time: float) -> float:
        """The integral of the distance from the origin over time, up to `time` [m s]: what a moving average needs."""
        return float(_KERNELS.s_curve_integral(self.numbers, time))


def plan_s_curve(profile: Profile, origin: float, destination: float, start_time: float) -> SCurve:
    """The fastest trip within the limits of `profile` from rest at `origin` [m] to rest at `destination` [m].

    A trip that cannot reach the speed has no cruise; one that cannot reach the acceleration has no plateau:

        plateau > 0:  a (plateau + ramp)(plateau + 2 ramp) = distance,  ramp = a / jerk
        plateau = 0:  2 jerk ramp^3 = distance
    """
    trip = [0.0] * TRIP
    _KERNELS.plan_s_curve_into(trip, start_time, origin, destination, profile.speed, profile.acceleration, profile.jerk)
    return SCurve(start_time, origin, destination, trip[JERK], trip[RAMP], trip[PLATEAU], trip[CRUISE])
