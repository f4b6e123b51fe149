"""Reference of the servo: a trip passed through a moving average and an input shaper; see `trajectory.reference_trajectory`."""

from math import exp, pi, sqrt

from ....kernels.jit import kernel
from ..arguments import (
    ACCELERATIONS,
    BEGIN,
    DELAYS,
    DURATION,
    END,
    FREE,
    IMPULSES,
    INTERVALS,
    ORIGIN,
    SMOOTHING,
    WEIGHTS,
)
from ..parameter_vector import (
    ACCELERATION_LIMIT,
    HEIGHT,
    IMPULSE_COUNT,
    JERK_LIMIT,
    PERIOD_LANDING,
    PERIOD_MIDDLE,
    SHAPER_DAMPING,
    SHARES,
    SMOOTHING_TIME,
    SPEED_LIMIT,
    TOLERANCE,
)
from .free_curve import free_curve_at, free_curve_integral, least_duration, set_knots
from .s_curve import plan_s_curve_into, s_curve_at, s_curve_integral


@kernel
def period_of_trip(origin, destination, height, period_landing, period_middle):
    """The undamped design period [s]: linear in the distance of the trip's midpoint from the middle of the shaft."""
    share = abs(origin + destination - height) / height
    return period_middle + share * (period_landing - period_middle)


@kernel
def set_impulses(trip, count, damping, tolerance, period):
    """Delays [s] and weights of the shaper for an undamped period [s]."""
    root = sqrt(1.0 - damping * damping)
    fall, half = exp(-damping * pi / root), 0.5 * period / root
    trip[IMPULSES] = count
    trip[WEIGHTS], trip[WEIGHTS + 1], trip[WEIGHTS + 2] = 1.0, 0.0, 0.0
    if count == 2.0:
        trip[WEIGHTS + 1] = fall
    if count == 3.0:
        trip[WEIGHTS] = 1.0 + tolerance
        trip[WEIGHTS + 1] = 2.0 * (1.0 - tolerance) * fall
        trip[WEIGHTS + 2] = (1.0 + tolerance) * (fall * fall)
    total = trip[WEIGHTS] + trip[WEIGHTS + 1] + trip[WEIGHTS + 2]
    for k in range(3):
        trip[WEIGHTS + k] /= total
        trip[DELAYS + k] = k * half if k < count else 0.0


@kernel
def reference_end(trip):
    """When the reference is at rest at the destination [s]."""
    return trip[BEGIN] + (trip[DURATION] + trip[SMOOTHING] + trip[DELAYS + int(trip[IMPULSES]) - 1])


@kernel
def _unshaped_at(trip, time):
    if trip[FREE] != 0.0:
        return free_curve_at(trip, time)
    return s_curve_at(trip, time)


@kernel
def _unshaped_integral(trip, time):
    if trip[FREE] != 0.0:
        return free_curve_integral(trip, time)
    return s_curve_integral(trip, time)


@kernel
def _smoothed_at(trip, time):
    """The trip after the moving average: velocity = (p(t) - p(t - S))/S, position from the integral of p likewise."""
    S = trip[SMOOTHING]
    x, v, a, j = _unshaped_at(trip, time)
    if S == 0.0:
        return x, v, a, j
    x0, v0, a0, _ = _unshaped_at(trip, time - S)
    travelled = (_unshaped_integral(trip, time) - _unshaped_integral(trip, time - S)) / S
    return trip[ORIGIN] + travelled, (x - x0) / S, (v - v0) / S, (a - a0) / S


@kernel
def reference_at(trip, time):
    """Position [m], velocity, acceleration and jerk of the reference at a time [s]."""
    if time >= reference_end(trip):
        return trip[END], 0.0, 0.0, 0.0
    count = int(trip[IMPULSES])
    if count == 1:
        return _smoothed_at(trip, time)
    travelled, velocity, acceleration, jerk = 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        weight = trip[WEIGHTS + k]
        x, v, a, j = _smoothed_at(trip, time - trip[DELAYS + k])
        travelled += weight * (x - trip[ORIGIN])
        velocity, acceleration, jerk = velocity + weight * v, acceleration + weight * a, jerk + weight * j
    return trip[ORIGIN] + travelled, velocity, acceleration, jerk


@kernel
def plan_trip(p, trip, begin, origin, destination):
    """Write the trip from rest at `origin` [m] at `begin` [s] to rest at `destination` [m], smoothed and shaped."""
    plan_s_curve_into(trip, begin, origin, destination, p[SPEED_LIMIT], p[ACCELERATION_LIMIT], p[JERK_LIMIT])
    trip[FREE], trip[SMOOTHING] = 0.0, 0.0
    set_impulses(trip, 1.0, 0.0, 0.0, 0.0)
    if origin == destination:
        return
    trip[SMOOTHING] = p[SMOOTHING_TIME]
    period = period_of_trip(origin, destination, p[HEIGHT], p[PERIOD_LANDING], p[PERIOD_MIDDLE])
    set_impulses(trip, p[IMPULSE_COUNT], p[SHAPER_DAMPING], p[TOLERANCE], period)
    trip[ACCELERATIONS], trip[ACCELERATIONS + INTERVALS] = 0.0, 0.0
    for k in range(1, INTERVALS):
        trip[ACCELERATIONS + k] = p[SHARES + k - 1]
        if p[SHARES + k - 1] != 0.0:
            trip[FREE] = 1.0
    if trip[FREE] != 0.0:
        distance = abs(destination - origin)
        trip[DURATION] = least_duration(
            trip, ACCELERATIONS, distance, p[SPEED_LIMIT], p[ACCELERATION_LIMIT], p[JERK_LIMIT]
        )
        set_knots(trip)
