"""Reference trajectory of the servo: a jerk-limited or free-form trip, smoothed and shaped.

Smoothing is a moving average over the last S seconds, which makes the jerk continuous:

    velocity = (p(t) - p(t - S)) / S,   position = (W(t) - W(t - S)) / S   with W the integral of p

Neither a moving average nor an input shaper exceeds a limit that the trip meets.
"""

from dataclasses import dataclass

from ..parameters import Drive
from .free_curve import FreeCurve, curved
from .input_shaper import NONE, Impulses, impulses
from .s_curve import SCurve, TrajectoryPoint, plan_s_curve


@dataclass(frozen=True)
class ReferenceTrajectory:
    """A trip passed through a moving average of `smoothing` [s] and through a shaper's `impulses` (delay [s], share)."""

    trip: SCurve | FreeCurve
    smoothing: float = 0.0
    impulses: Impulses = NONE

    @property
    def start_time(self) -> float:
        """Start of the motion of the reference [s]."""
        return self.trip.start_time

    @property
    def origin(self) -> float:
        """Start position [m]."""
        return self.trip.origin

    @property
    def destination(self) -> float:
        """Final position [m]."""
        return self.trip.destination

    @property
    def duration(self) -> float:
        """Time [s] from rest to rest: the trip's own, the average's and the shaper's."""
        return self.trip.duration + self.smoothing + self.impulses[-1][0]

    @property
    def end_time(self) -> float:
        """When the reference is at rest at the destination [s]."""
        return self.trip.start_time + self.duration

    def at(self, time: float) -> TrajectoryPoint:
        """The reference at `time` [s]; at rest before the trip begins and after it ends."""
        if time >= self.end_time:
            return TrajectoryPoint(self.destination)
        if len(self.impulses) == 1:
            return self._smoothed(time)
        moved = [(share, self._smoothed(time - delay)) for delay, share in self.impulses]
        return TrajectoryPoint(
            self.origin + sum(share * (one.position - self.origin) for share, one in moved),
            sum(share * one.velocity for share, one in moved),
            sum(share * one.acceleration for share, one in moved),
            sum(share * one.jerk for share, one in moved),
        )

    def _smoothed(self, time: float) -> TrajectoryPoint:
        S = self.smoothing
        now = self.trip.at(time)
        if S == 0.0:
            return now
        then = self.trip.at(time - S)
        return TrajectoryPoint(
            self.origin + (self.trip.gone(time) - self.trip.gone(time - S)) / S,
            (now.position - then.position) / S,
            (now.velocity - then.velocity) / S,
            (now.acceleration - then.acceleration) / S,
        )


def reference_trajectory(drive: Drive, trip: SCurve) -> ReferenceTrajectory:
    """The course of a planned trip with the drive's curve, smoothing and shaper; a trip of no way has none of these."""
    origin, destination = trip.origin, trip.destination
    if origin == destination:
        return ReferenceTrajectory(trip)
    chosen = curved(drive.curve, drive.profile, origin, destination, trip.start_time) if drive.curve.used else trip
    return ReferenceTrajectory(chosen, drive.profile.smoothing, impulses(drive.shaper, (origin, destination), drive.shaft.height))


def first_trajectory(drive: Drive) -> ReferenceTrajectory:
    """The course of the drive's first trip."""
    return reference_trajectory(
        drive, plan_s_curve(drive.profile, drive.trip.start_position, drive.trip.destination, drive.trip.start_time)
    )
