"""Reference trajectory of a drive as arrays over time: the same values as `ReferenceTrajectory.at`, for the search."""

from dataclasses import dataclass
from math import factorial

import numpy as np
from numpy.typing import NDArray

from comprope.drive.parameters import PARTS
from comprope.drive.trajectory.free_curve import FreeCurve
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory
from comprope.drive.trajectory.s_curve import SCurve

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Moves:
    """Times `dt` [s] apart from zero, and the car's position [m], speed [m/s] and acceleration [m/s2], each (n,)."""

    dt: float
    position: Floats
    speed: Floats
    acceleration: Floats

    @property
    def time(self) -> Floats:
        """Sample times [s]."""
        return np.asarray(self.dt * np.arange(len(self.position)), float)


def moves(course: ReferenceTrajectory, until: float, dt: float) -> Moves:
    """The trajectory from time zero to `until` [s] or slightly longer."""
    time = np.asarray(dt * np.arange(int(np.ceil(until / dt)) + 1), float)
    total = np.zeros((3, len(time)))
    for delay, share in course.impulses:
        total += share * _smoothed(course, time - delay)
    over = time >= course.end_time
    total[1:, over] = 0.0
    way = np.where(over, course.destination - course.origin, total[0])
    return Moves(dt, np.asarray(course.origin + way, float), total[1], total[2])


def _smoothed(course: ReferenceTrajectory, time: Floats) -> Floats:
    """Distance, speed and acceleration (3, n) of the trip after the moving average."""
    values = _curve if isinstance(course.trip, FreeCurve) else _trip
    gone, way, speed, acceleration = values(course.trip, time)  # type: ignore[arg-type]
    S = course.smoothing
    if S == 0.0:
        return np.array([way, speed, acceleration])
    before, way0, speed0, _ = values(course.trip, time - S)  # type: ignore[arg-type]
    return np.array([gone - before, way - way0, speed - speed0]) / S


def _trip(trip: SCurve, time: Floats) -> Floats:
    """Integral of the distance, distance, speed and acceleration (4, n); the second half mirrors the first."""
    distance, half = trip.destination - trip.origin, 0.5 * trip.duration
    elapsed = np.clip(time - trip.start_time, 0.0, trip.duration)
    left = trip.duration - elapsed
    first, s = elapsed <= left, np.minimum(elapsed, left)
    gone, way, speed, acceleration = (_begun(trip, s, order) for order in (4, 3, 2, 1))
    over = np.maximum(time - trip.end_time, 0.0)
    return np.array([
        np.where(first, gone, distance * (elapsed - half) + gone) + distance * over,
        np.where(first, way, distance - way), speed, np.where(first, acceleration, -acceleration),
    ])  # fmt: skip


def _begun(trip: SCurve, s: Floats, order: int) -> Floats:
    """The jerk's integral of an order up to times `s` [s] in the first half: j, -j and again -j, j at their times."""
    total = s**order
    for shift, sign in ((trip.ramp, -1.0), (trip.ramp + trip.plateau, -1.0), (2.0 * trip.ramp + trip.plateau, 1.0)):
        total = total + sign * np.maximum(s - shift, 0.0) ** order
    return np.asarray(trip.jerk / factorial(order) * total)


def _curve(trip: FreeCurve, time: Floats) -> Floats:
    """The same for a free-form trip."""
    dt, elapsed = trip.duration / PARTS, np.clip(time - trip.start_time, 0.0, trip.duration)
    k = np.minimum((elapsed / dt).astype(int), PARTS - 1)
    t, (a, v, x, gone) = elapsed - k * dt, (np.array(one) for one in trip.knots)
    j, over = (a[k + 1] - a[k]) / dt, np.maximum(time - trip.end_time, 0.0) * (trip.destination - trip.origin)
    a, v, x, gone = a[k], v[k], x[k], gone[k]
    return np.array([
        over + gone + t * (x + t * (v / 2.0 + t * (a / 6.0 + t * j / 24.0))),
        x + t * (v + t * (a / 2.0 + t * j / 6.0)), v + t * (a + t * j / 2.0), a + t * j,
    ])  # fmt: skip
