"""Free-form trips: accelerations at equal intervals of the travel time, linear in between; see `trajectory.free_curve`."""

from ....kernels.jit import kernel
from ..arguments import ACCELERATIONS, BEGIN, DISTANCES, DURATION, END, INTEGRALS, INTERVALS, ORIGIN, SPEEDS


@kernel
def unit_distance_of(shape, at):
    """The distance of the shape that begins at an index, for unit largest acceleration and unit duration."""
    speed, distance = 0.0, 0.0
    for k in range(at, at + INTERVALS):
        b, c = shape[k], shape[k + 1]
        distance += (speed + (2.0 * b + c) / 6.0 / INTERVALS) / INTERVALS
        speed += (b + c) / 2.0 / INTERVALS
    return distance


@kernel
def _peaks(shape, at):
    """Largest acceleration, speed and jerk of a shape, for unit largest acceleration and unit duration."""
    speed, most, fastest, jerk = 0.0, 0.0, 0.0, 0.0
    for k in range(at, at + INTERVALS):
        b, c = shape[k], shape[k + 1]
        if b > 0.0 and c < 0.0:  # between two knots
            fastest = max(fastest, speed + b * b / (b - c) / 2.0 / INTERVALS)
        speed += (b + c) / 2.0 / INTERVALS
        most, fastest, jerk = max(most, abs(b), abs(c)), max(fastest, speed), max(jerk, abs(c - b))
    return most, fastest, INTERVALS * jerk


@kernel
def least_duration(shape, at, distance, speed, acceleration, jerk):
    """The least time [s] in which a shape covers the distance [m] within the limits."""
    unit = unit_distance_of(shape, at)
    most, fastest, steepest = _peaks(shape, at)
    return max(
        (distance * most / (unit * acceleration)) ** 0.5,
        distance * fastest / (unit * speed),
        (distance * steepest / (unit * jerk)) ** (1.0 / 3.0),
    )


@kernel
def set_knots(trip):
    """Scale the shape that stands among the trip's accelerations, and integrate it three times."""
    dt, distance = trip[DURATION] / INTERVALS, trip[END] - trip[ORIGIN]
    most = 0.0
    if distance != 0.0:
        most = distance / (trip[DURATION] * trip[DURATION] * unit_distance_of(trip, ACCELERATIONS))
    for k in range(ACCELERATIONS, ACCELERATIONS + INTERVALS + 1):
        trip[k] *= most
    trip[SPEEDS], trip[DISTANCES], trip[INTEGRALS] = 0.0, 0.0, 0.0
    for k in range(INTERVALS):
        b, c = trip[ACCELERATIONS + k], trip[ACCELERATIONS + k + 1]
        v, x = trip[SPEEDS + k], trip[DISTANCES + k]
        trip[SPEEDS + k + 1] = v + dt * (b + c) / 2.0
        trip[DISTANCES + k + 1] = x + dt * v + dt * dt * (2.0 * b + c) / 6.0
        trip[INTEGRALS + k + 1] = (
            trip[INTEGRALS + k] + dt * x + dt * dt * v / 2.0 + dt * dt * dt * (3.0 * b + c) / 24.0
        )


@kernel
def _interval_at(trip, time):
    """Index of the interval at a time, time since its begin [s], and jerk in it [m/s3]."""
    dt = trip[DURATION] / INTERVALS
    k = min(int((time - trip[BEGIN]) / dt), INTERVALS - 1)
    return k, time - trip[BEGIN] - k * dt, (trip[ACCELERATIONS + k + 1] - trip[ACCELERATIONS + k]) / dt


@kernel
def free_curve_at(trip, time):
    """Position [m], velocity, acceleration and jerk at a time [s]; at rest before the trip and after it."""
    if time >= trip[BEGIN] + trip[DURATION]:
        return trip[END], 0.0, 0.0, 0.0
    if time <= trip[BEGIN]:
        return trip[ORIGIN], 0.0, 0.0, 0.0
    k, t, j = _interval_at(trip, time)
    a, v, x = trip[ACCELERATIONS + k], trip[SPEEDS + k], trip[DISTANCES + k]
    displacement = x + v * t + a * t * t / 2.0 + j * t * t * t / 6.0
    return trip[ORIGIN] + displacement, v + a * t + j * t * t / 2.0, a + j * t, j


@kernel
def free_curve_integral(trip, time):
    """The integral of the distance from the origin over time, up to a time [m s]."""
    end = trip[BEGIN] + trip[DURATION]
    over = max(time - end, 0.0) * (trip[END] - trip[ORIGIN])
    if time <= trip[BEGIN]:
        return 0.0
    k, t, j = _interval_at(trip, min(time, end))
    a, v, x, integral = trip[ACCELERATIONS + k], trip[SPEEDS + k], trip[DISTANCES + k], trip[INTEGRALS + k]
    return over + integral + x * t + v * t * t / 2.0 + a * t * t * t / 6.0 + j * (t * t) * (t * t) / 24.0
