"""Lower bound of the residual vibration at a fixed period for any acceleration profile within the limits.

The residual vibration of angular frequency w is proportional to the spectrum of the acceleration, w |V(w)| with V that of the
speed. The minimum over all profiles of a duration is attained by a symmetric one (the mean of any profile and its mirror image
is at least as good), so that it is the solution of a linear program. For a car that never reverses, a trip shorter than half a
period leaves at least cos(pi T / period) of the vibration of an impulse, whatever its limits.
"""

from math import pi

import numpy as np
from scipy.optimize import linprog

from comprope.drive.parameters import Drive
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory

from ...vibration.reduced_model.sampled_motion import sample_motion
from .profile_families import Route

PARTS = 40  # of half the travel time
MAX_TIME_FACTOR = 6.0  # of the shortest time: beyond that nothing is looked for


def speed_spectrum(trajectory: ReferenceTrajectory, period: float) -> float:
    """|V(w)| / distance of a trajectory, 1 for an impulse, at the angular frequency of `period` [s]."""
    motion = sample_motion(trajectory, trajectory.end_time, 0.005)
    distance = abs(trajectory.destination - trajectory.origin)
    return float(abs(np.sum(motion.speed * np.exp(-2j * pi * motion.time / period)) * motion.dt) / distance)


def minimum_spectrum(drive: Drive, route: Route, time: float, period: float) -> float:
    """Minimum of |V(w)| / distance over all trips of `time` [s] within the drive's limits; infinite if none is so fast."""
    own, dt, distance = drive.profile, 0.5 * time / PARTS, route.distance
    t = dt * np.arange(PARTS + 1) - 0.5 * time  # the first half: its speeds are those of the second, mirrored
    weight = dt * np.ones(PARTS + 1)
    weight[[0, -1]] *= 0.5
    first = np.diff(np.eye(PARTS + 1), axis=0) / dt
    second = np.diff(np.vstack([np.zeros(PARTS), np.eye(PARTS), np.zeros(PARTS)]), axis=0) @ first / dt
    rows = np.vstack([first, -first, second, -second])
    maxima = np.concatenate([np.full(2 * PARTS, own.acceleration), np.full(2 * len(second), own.jerk * (1.0 + 1.0 / PARTS))])
    spectral = 2.0 * weight * np.cos(2.0 * pi * t / period) / distance
    rows = np.vstack([np.hstack([rows, np.zeros((len(rows), 1))]), [*spectral, -1.0], [*-spectral, -1.0]])
    bounds = [(0.0, 0.0)] + [(0.0, own.speed)] * PARTS + [(0.0, None)]
    cost, equal = np.append(np.zeros(PARTS + 1), 1.0), np.append(2.0 * weight, 0.0)[None, :]
    found = linprog(cost, rows, np.concatenate([maxima, [0.0, 0.0]]), equal, [distance], bounds, method="highs")
    return float(found.fun) if found.status == 0 else np.inf


def minimum_time(drive: Drive, route: Route, trajectory: ReferenceTrajectory, period: float, share: float) -> float:
    """Shortest time [s] of a trip with at most `share` of the residual vibration of `trajectory`; infinite if none is found."""
    allowed = share * speed_spectrum(trajectory, period)
    low, high = trajectory.duration * 0.98, trajectory.duration * MAX_TIME_FACTOR
    if minimum_spectrum(drive, route, high, period) > allowed:
        return np.inf
    while high - low > 0.005 * trajectory.duration:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if minimum_spectrum(drive, route, middle, period) <= allowed else (middle, high)
    return high


def unavoidable_share(time: float, period: float) -> float:
    """Lower bound of the residual vibration of a trip of `time` [s] relative to an impulse; 0 from half a period."""
    return max(0.0, float(np.cos(pi * time / period))) if time < 0.5 * period else 0.0
