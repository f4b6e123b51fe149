"""Reference trajectory of a drive as arrays over time: the same values as `ReferenceTrajectory.at`, for the search."""

from dataclasses import dataclass
from math import factorial

import numpy as np
from numpy.typing import NDArray

from comprope.drive.parameters import INTERVALS
from comprope.drive.trajectory.free_curve import FreeCurve
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory
from comprope.drive.trajectory.s_curve import SCurve

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SampledMotion:
    """Times `dt` [s] apart from zero, and the car's position [m], speed [m/s] and acceleration [m/s2], each (n,)."""

    dt: float
    position: Floats
    speed: Floats
    acceleration: Floats

    @property
    def time(self) -> Floats:
        """Sample times [s]."""
        return np.asarray(self.dt * np.arange(len(self.position)), float)


def sample_motion(trajectory: ReferenceTrajectory, until: float, dt: float) -> SampledMotion:
    """The trajectory from time zero to `until` [s] or slightly longer."""
    time = np.asarray(dt * np.arange(int(np.ceil(until / dt)) + 1), float)
    total = np.zeros((3, len(time)))
    for delay, share in trajectory.impulses:
        total += share * _smoothed(trajectory, time - delay)
    after_end = time >= trajectory.end_time
    total[1:, after_end] = 0.0
    travel = np.where(after_end, trajectory.destination - trajectory.origin, total[0])
    return SampledMotion(dt, np.asarray(trajectory.origin + travel, float), total[1], total[2])


def _smoothed(trajectory: ReferenceTrajectory, time: Floats) -> Floats:
    """Distance, speed and acceleration (3, n) of the trip after the moving average."""
    values = _curve if isinstance(trajectory.unshaped, FreeCurve) else _trip
    travel_integral, travel, speed, acceleration = values(trajectory.unshaped, time)  # type: ignore[arg-type]
    S = trajectory.smoothing
    if S == 0.0:
        return np.array([travel, speed, acceleration])
    before, travel0, speed0, _ = values(trajectory.unshaped, time - S)  # type: ignore[arg-type]
    return np.array([travel_integral - before, travel - travel0, speed - speed0]) / S


def _trip(trip: SCurve, time: Floats) -> Floats:
    """Integral of the distance, distance, speed and acceleration (4, n); the second half mirrors the first."""
    distance, half = trip.destination - trip.origin, 0.5 * trip.duration
    elapsed = np.clip(time - trip.start_time, 0.0, trip.duration)
    left = trip.duration - elapsed
    first, s = elapsed <= left, np.minimum(elapsed, left)
    travel_integral, travel, speed, acceleration = (_begun(trip, s, order) for order in (4, 3, 2, 1))
    after_end = np.maximum(time - trip.end_time, 0.0)
    return np.array([
        np.where(first, travel_integral, distance * (elapsed - half) + travel_integral) + distance * after_end,
        np.where(first, travel, distance - travel), speed, np.where(first, acceleration, -acceleration),
    ])  # fmt: skip


def _begun(trip: SCurve, s: Floats, order: int) -> Floats:
    """The jerk's integral of an order up to times `s` [s] in the first half: j, -j and again -j, j at their times."""
    total = s**order
    for shift, sign in ((trip.ramp, -1.0), (trip.ramp + trip.plateau, -1.0), (2.0 * trip.ramp + trip.plateau, 1.0)):
        total = total + sign * np.maximum(s - shift, 0.0) ** order
    return np.asarray(trip.jerk / factorial(order) * total)


def _curve(trip: FreeCurve, time: Floats) -> Floats:
    """The same for a free-form trip."""
    dt, elapsed = trip.duration / INTERVALS, np.clip(time - trip.start_time, 0.0, trip.duration)
    k = np.minimum((elapsed / dt).astype(int), INTERVALS - 1)
    t, (a, v, x, travel_integral) = elapsed - k * dt, (np.array(one) for one in trip.knots)
    j, after_end = (a[k + 1] - a[k]) / dt, np.maximum(time - trip.end_time, 0.0) * (trip.destination - trip.origin)
    a, v, x, travel_integral = a[k], v[k], x[k], travel_integral[k]
    return np.array([
        after_end + travel_integral + t * (x + t * (v / 2.0 + t * (a / 6.0 + t * j / 24.0))),
        x + t * (v + t * (a / 2.0 + t * j / 6.0)), v + t * (a + t * j / 2.0), a + t * j,
    ])  # fmt: skip
