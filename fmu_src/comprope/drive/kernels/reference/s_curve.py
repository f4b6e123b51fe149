"""Jerk-limited trips from rest to rest, in closed form; see `trajectory.s_curve` for the phases."""

from ....kernels.jit import kernel
from ..arguments import BEGIN, CRUISE, DURATION, END, JERK, ORIGIN, PLATEAU, RAMP


@kernel
def phase_durations(distance, speed, acceleration, jerk):
    """Durations of jerk, full acceleration and full speed [s] of a trip over `distance` [m]."""
    to_acceleration = acceleration / jerk
    ramp = min(to_acceleration, (speed / jerk) ** 0.5)
    plateau = max(0.0, speed / acceleration - to_acceleration)
    needed = speed * (2.0 * ramp + plateau)  # to reach the speed and to stop again
    if distance >= needed:
        return ramp, plateau, (distance - needed) / speed
    ramp = min(to_acceleration, (distance / (2.0 * jerk)) ** (1.0 / 3.0))
    if ramp < to_acceleration:
        return ramp, 0.0, 0.0
    plateau = ((ramp * ramp + 4.0 * distance / acceleration) ** 0.5 - 3.0 * ramp) / 2.0
    return ramp, max(0.0, plateau), 0.0


@kernel
def s_curve_at(trip, time):
    """Position [m], velocity, acceleration and jerk at a time [s]; at rest before the trip and after it."""
    elapsed = time - trip[BEGIN]
    left = trip[BEGIN] + trip[DURATION] - time
    if elapsed <= 0.0 and left > 0.0:
        return trip[ORIGIN], 0.0, 0.0, 0.0
    if left <= 0.0:
        return trip[END], 0.0, 0.0, 0.0
    if elapsed <= left:
        displacement, velocity, acceleration, jerk = _first_half(trip, elapsed)
        return trip[ORIGIN] + displacement, velocity, acceleration, jerk
    displacement, velocity, acceleration, jerk = _first_half(trip, left)
    return trip[END] - displacement, velocity, -acceleration, jerk


@kernel
def s_curve_integral(trip, time):
    """The integral of the distance from the origin over time, up to a time [m s]."""
    elapsed = time - trip[BEGIN]
    left = trip[BEGIN] + trip[DURATION] - time
    if elapsed <= 0.0:
        return 0.0
    if elapsed <= left:
        return _first_half_integral(trip, elapsed)
    return (trip[END] - trip[ORIGIN]) * (elapsed - 0.5 * trip[DURATION]) + _first_half_integral(trip, max(left, 0.0))


@kernel
def _first_half(trip, t):
    """Displacement, velocity, acceleration and jerk at t [s] after the start, up to half of the duration."""
    j, ramp, plateau = trip[JERK], trip[RAMP], trip[PLATEAU]
    if t < ramp:
        return j * t * t * t / 6.0, j * t * t / 2.0, j * t, j
    a = j * ramp
    t = t - ramp
    if t < plateau:
        return a * (ramp * ramp / 6.0 + ramp * t / 2.0 + t * t / 2.0), a * (ramp / 2.0 + t), a, 0.0
    v = a * (ramp + plateau)
    until_speed = ramp - (t - plateau)  # the same ramp, seen from the moment at which speed is reached
    displacement = v * (t - plateau / 2.0)
    if until_speed > 0.0:
        left = j * until_speed
        return displacement + left * until_speed * until_speed / 6.0, v - left * until_speed / 2.0, left, -j
    return displacement, v, 0.0, 0.0


@kernel
def _first_half_integral(trip, t):
    """The integral of the distance from the start to t [s] after it, up to half of the duration."""
    j, ramp, plateau = trip[JERK], trip[RAMP], trip[PLATEAU]
    if t < ramp:
        return j * (t * t) * (t * t) / 24.0
    fourth = (ramp * ramp) * (ramp * ramp)
    a, integral = j * ramp, j * fourth / 24.0
    u = min(t - ramp, plateau)
    integral += a * (ramp * ramp * u / 6.0 + ramp * u * u / 4.0 + u * u * u / 6.0)
    v, u = a * (ramp + plateau), max(t - ramp - plateau, 0.0)
    left = max(ramp - u, 0.0)
    return integral + v * (u * u / 2.0 + plateau * u / 2.0) + j * (fourth - (left * left) * (left * left)) / 24.0


@kernel
def plan_s_curve_into(trip, begin, origin, destination, speed, acceleration, jerk):
    """Write the fastest trip within the limits, from rest at `origin` [m] at `begin` [s] to rest at `destination` [m]."""
    ramp, plateau, cruise = phase_durations(abs(destination - origin), speed, acceleration, jerk)
    trip[BEGIN], trip[ORIGIN], trip[END] = begin, origin, destination
    trip[JERK] = jerk if destination >= origin else -jerk
    trip[RAMP], trip[PLATEAU], trip[CRUISE] = ramp, plateau, cruise
    trip[DURATION] = 4.0 * ramp + 2.0 * plateau + cruise
