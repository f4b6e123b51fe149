"""Jerk-limited trips from rest to rest, in closed form.

A trip has seven phases: the jerk lasts `ramp`, the full acceleration `plateau`, the jerk again
`ramp`, the full speed `cruise`, and then the same in reverse. Short trips have no cruise, shorter
ones no plateau either. The second half is computed as the mirror image of the first, so that
a trip ends exactly at its destination.
"""

from dataclasses import dataclass

from ..parameters import Profile


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

    def at(self, time: float) -> TrajectoryPoint:
        """The reference at `time` [s]; at rest before the trip begins and after it ends."""
        elapsed, left = time - self.start_time, self.end_time - time
        if elapsed <= 0.0 and left > 0.0:
            return TrajectoryPoint(self.origin)
        if left <= 0.0:
            return TrajectoryPoint(self.destination)
        if elapsed <= left:
            displacement, velocity, acceleration, jerk = self._first_half(elapsed)
            return TrajectoryPoint(self.origin + displacement, velocity, acceleration, jerk)
        displacement, velocity, acceleration, jerk = self._first_half(left)
        return TrajectoryPoint(self.destination - displacement, velocity, -acceleration, jerk)

    def displacement_integral(self, time: float) -> float:
        """The integral of the distance from the origin over time, up to `time` [m s]: what a moving average needs."""
        elapsed, left = time - self.start_time, self.end_time - time
        if elapsed <= 0.0:
            return 0.0
        if elapsed <= left:
            return self._first_half_integral(elapsed)
        return (self.destination - self.origin) * (elapsed - 0.5 * self.duration) + self._first_half_integral(max(left, 0.0))

    def _first_half_integral(self, t: float) -> float:
        """The integral of the distance from the start to `t` after it, up to half of the duration."""
        j, ramp, plateau = self.jerk, self.ramp, self.plateau
        if t < ramp:
            return j * t**4 / 24.0
        a, integral = j * ramp, j * ramp**4 / 24.0
        u = min(t - ramp, plateau)
        integral += a * (ramp**2 * u / 6.0 + ramp * u**2 / 4.0 + u**3 / 6.0)
        v, u = a * (ramp + plateau), max(t - ramp - plateau, 0.0)
        return integral + v * (u**2 / 2.0 + plateau * u / 2.0) + j * (ramp**4 - max(ramp - u, 0.0) ** 4) / 24.0

    def _first_half(self, t: float) -> tuple[float, float, float, float]:
        """Displacement, velocity, acceleration and jerk at `t` after the start, up to half of the duration."""
        j, ramp, plateau = self.jerk, self.ramp, self.plateau
        if t < ramp:
            return j * t**3 / 6.0, j * t**2 / 2.0, j * t, j
        a = j * ramp
        t -= ramp
        if t < plateau:
            return a * (ramp**2 / 6.0 + ramp * t / 2.0 + t**2 / 2.0), a * (ramp / 2.0 + t), a, 0.0
        v = a * (ramp + plateau)
        until_speed = ramp - (t - plateau)  # the same ramp, seen from the moment at which speed is reached
        displacement = v * (t - plateau / 2.0)
        if until_speed > 0.0:
            return displacement + j * until_speed**3 / 6.0, v - j * until_speed**2 / 2.0, j * until_speed, -j
        return displacement, v, 0.0, 0.0


def plan_s_curve(profile: Profile, origin: float, destination: float, start_time: float) -> SCurve:
    """The fastest trip within the limits of `profile` from rest at `origin` [m] to rest at `destination` [m].

    A trip that cannot reach the speed has no cruise; one that cannot reach the acceleration has no plateau:

        plateau > 0:  a (plateau + ramp)(plateau + 2 ramp) = distance,  ramp = a / jerk
        plateau = 0:  2 jerk ramp^3 = distance
    """
    distance = abs(destination - origin)
    ramp, plateau, cruise = _phase_durations(distance, profile.speed, profile.acceleration, profile.jerk)
    jerk = profile.jerk if destination >= origin else -profile.jerk
    return SCurve(start_time, origin, destination, jerk, ramp, plateau, cruise)


def _phase_durations(distance: float, speed: float, acceleration: float, jerk: float) -> tuple[float, float, float]:
    """Durations of jerk, full acceleration and full speed [s]."""
    to_acceleration = acceleration / jerk
    ramp = min(to_acceleration, (speed / jerk) ** 0.5)
    plateau = max(0.0, speed / acceleration - to_acceleration)
    needed = speed * (2.0 * ramp + plateau)  # to reach the speed and to stop again
    if distance >= needed:
        return ramp, plateau, (distance - needed) / speed
    ramp = min(to_acceleration, (distance / (2.0 * jerk)) ** (1.0 / 3.0))
    if ramp < to_acceleration:
        return ramp, 0.0, 0.0
    plateau = ((ramp**2 + 4.0 * distance / acceleration) ** 0.5 - 3.0 * ramp) / 2.0
    return ramp, max(0.0, plateau), 0.0
