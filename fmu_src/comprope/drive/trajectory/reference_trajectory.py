"""Reference trajectory of the servo: a jerk-limited or free-form trip, smoothed and shaped.

Smoothing is a moving average over the last S seconds, which makes the jerk continuous:

    velocity = (p(t) - p(t - S)) / S,   position = (W(t) - W(t - S)) / S   with W the integral of p

Neither a moving average nor an input shaper exceeds a limit that the trip meets.
"""

from dataclasses import dataclass
from functools import cached_property
from math import copysign

from ...kernels.kernel_linking import uncompiled
from ..kernels.arguments import DELAYS, IMPULSES, SMOOTHING, TRIP, WEIGHTS
from ..kernels.reference import free_curve, s_curve, shaped_trip
from ..parameters import Drive
from .free_curve import FreeCurve, plan_free_curve
from .input_shaper import NO_SHAPING, Impulses, impulses
from .s_curve import SCurve, TrajectoryPoint, plan_s_curve

_KERNELS = uncompiled(s_curve, free_curve, shaped_trip)


@dataclass(frozen=True)
class ReferenceTrajectory:
    """A trip passed through a moving average of `smoothing` [s] and through a shaper's `impulses` (delay [s], weight)."""

    unshaped: SCurve | FreeCurve
    smoothing: float = 0.0
    impulses: Impulses = NO_SHAPING

    @property
    def start_time(self) -> float:
        """Start of the motion of the reference [s]."""
        return self.unshaped.start_time

    @property
    def origin(self) -> float:
        """Start position [m]."""
        return self.unshaped.origin

    @property
    def destination(self) -> float:
        """Final position [m]."""
        return self.unshaped.destination

    @property
    def duration(self) -> float:
        """Time [s] from rest to rest: the trip's own, the average's and the shaper's."""
        return self.unshaped.duration + self.smoothing + self.impulses[-1][0]

    @property
    def end_time(self) -> float:
        """When the reference is at rest at the destination [s]."""
        return self.unshaped.start_time + self.duration

    @cached_property
    def _numbers(self) -> tuple[float, ...]:
        """The trip as kernels have it."""
        trip = [*self.unshaped.numbers, *[0.0] * (TRIP - len(self.unshaped.numbers))]
        trip[SMOOTHING], trip[IMPULSES] = self.smoothing, float(len(self.impulses))
        for k, (delay, weight) in enumerate(self.impulses):
            trip[DELAYS + k], trip[WEIGHTS + k] = delay, weight
        return tuple(trip)

    def at(self, time: float) -> TrajectoryPoint:
        """The reference at `time` [s]; at rest before the trip begins and after it ends."""
        return TrajectoryPoint(*_KERNELS.reference_at(self._numbers, time))


def reference_trajectory(drive: Drive, trip: SCurve) -> ReferenceTrajectory:
    """The trajectory of a planned trip with the drive's curve, smoothing and shaper; none of these at zero distance."""
    origin, destination = trip.origin, trip.destination
    if origin == destination:
        return ReferenceTrajectory(trip)
    chosen = plan_free_curve(drive.curve, drive.profile, origin, destination, trip.start_time) if drive.curve.used else trip
    return ReferenceTrajectory(chosen, drive.profile.smoothing, impulses(drive.shaper, (origin, destination), drive.shaft.height))


def first_trajectory(drive: Drive) -> ReferenceTrajectory:
    """The trajectory of the drive's first trip, with its overrun."""
    start, end = drive.trip.start_position, drive.trip.destination
    end += copysign(drive.trip.overrun, end - start) if end != start else 0.0
    return reference_trajectory(drive, plan_s_curve(drive.profile, start, end, drive.trip.start_time))
