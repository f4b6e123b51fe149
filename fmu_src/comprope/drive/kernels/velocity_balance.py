"""Velocities of car, counterweight, hoist ropes and traction sheave at which the forces at the end of a time step balance.

The equations of a step are monotone: each end's velocity follows from that of the rope, which Newton's method finds. The ropes
go with the rim where traction and brake hold them, and else slide.
"""

from math import inf

from ...kernels.jit import kernel

_ITERATIONS = 60  # at most, of Newton's method and bisection; three are usual
_SAME = 1e-13  # m/s: rounding of velocities


@kernel
def _pulled(body, load, u):
    """Velocity [m/s] of a body at the end of a step, its rope's tension [N] and the derivative of that by the rope's velocity u.

    The body is its mass per step length, first velocity, load, friction against downward and upward motion, and its rope's
    tension and viscosity: (m/h, v, W, F, F', A, k).
    """
    mass, v, _, _, _, pull, viscosity = body
    inverse = 1.0 / (mass + viscosity)
    taut = (mass * v + pull + viscosity * u - load) * inverse
    tension = pull + viscosity * (u - taut)
    if tension > 0.0:
        return taut, tension, viscosity * mass * inverse
    return v - load / mass, 0.0, 0.0


@kernel
def pulled_end(body, u):
    """The same with the friction, which may hold the body at rest."""
    _, _, load, grip, upward, pull, viscosity = body
    v, tension, slope = _pulled(body, load, u)
    held = grip if v < 0.0 else -upward
    if held == 0.0:
        return v, tension, slope
    slowed, tension, slope = _pulled(body, load - held, u)
    if slowed * v > 0.0:
        return slowed, tension, slope
    tension = pull + viscosity * u
    return (0.0, tension, viscosity) if tension > 0.0 else (0.0, 0.0, 0.0)


@kernel
def _unbalance(rim, car, counterweight, v):
    """i (v - v_0) + a N_car - b N_counterweight + W of a rim (i, v_0, a, b, W) at a velocity of the rope; its derivative."""
    inertia, v0, a, b, load = rim
    _, pull, slope = pulled_end(car, v)
    _, other, other_slope = pulled_end(counterweight, -v)
    return inertia * (v - v0) + a * pull - b * other + load, inertia + a * slope + b * other_slope


@kernel
def _rope_velocity(rim, car, counterweight, brake):
    """The velocity of the rope at which its forces and a given force of the brake are in balance."""
    v, low, high = rim[1], -inf, inf
    for _ in range(_ITERATIONS):
        rest, slope = _unbalance(rim, car, counterweight, v)
        rest += brake
        if rest == 0.0 or slope == 0.0:
            break
        if rest > 0.0:
            high = v
        else:
            low = v
        following = v - rest / slope
        if abs(following - v) <= _SAME * (1.0 + abs(v)):
            return following
        if not low < following < high:
            following = 0.5 * (low + high)
        v = following
    return v


@kernel
def _sticking(rim, car, counterweight, brake):
    """The velocity of rope and rim together, which a brake may hold."""
    if brake == 0.0:
        return _rope_velocity(rim, car, counterweight, 0.0)
    rest, _ = _unbalance(rim, car, counterweight, 0.0)
    if abs(rest) <= brake:
        return 0.0
    return _rope_velocity(rim, car, counterweight, brake if rest < 0.0 else -brake)


@kernel
def _running_on(rope, car, counterweight, v):
    """Tensions [N] on both sides of the traction sheave with the rope at v: those at the ends, and the weight of the rope."""
    first, second, v0, inverse_step, gravity = rope
    _, pull, _ = pulled_end(car, v)
    _, other, _ = pulled_end(counterweight, -v)
    gained = (v - v0) * inverse_step
    return pull + first * (gravity + gained), other + second * (gravity - gained)


@kernel
def _sliding(rope, car, counterweight, sheave, way, ratio):
    """Velocities of rim and rope sliding one way (-1: to the car) with tensions of the ratio.

    `rope` holds its masses on both sides, first velocity, 1 / step, gravity; `sheave` its inertia per step, velocity, brake.
    """
    first, second, v0, inverse_step, gravity = rope
    inertia, rim, brake = sheave
    a, b = (1.0, ratio) if way < 0.0 else (ratio, 1.0)
    balance = ((a * first + b * second) * inverse_step, v0, a, b, (a * first - b * second) * gravity)
    v = _rope_velocity(balance, car, counterweight, 0.0)
    pull, other = _running_on(rope, car, counterweight, v)
    free, hold = rim - (pull - other) / inertia, brake / inertia
    return (0.0 if abs(free) <= hold else free - hold if free > 0.0 else free + hold), v


@kernel
def velocities_after(rope, car, counterweight, sheave, slip, ratio):
    """Velocities of rim and rope at the end of a step: together where traction holds them, else sliding; see `_sliding`."""
    first, second, v0, inverse_step, gravity = rope
    inertia, rim, brake = sheave
    if slip != 0.0:
        v_s, v = _sliding(rope, car, counterweight, sheave, slip, ratio)
        if (v - v_s) * slip > 0.0:
            return v_s, v
    ropes = (first + second) * inverse_step
    whole = inertia + ropes
    balance = (whole, (inertia * rim + ropes * v0) / whole, 1.0, 1.0, (first - second) * gravity)
    v = _sticking(balance, car, counterweight, brake)
    pull, other = _running_on(rope, car, counterweight, v)
    if pull > ratio * other or other > ratio * pull:
        way = -1.0 if pull > other else 1.0
        v_s, sliding = _sliding(rope, car, counterweight, sheave, way, ratio)
        if (sliding - v_s) * way > 0.0:
            return v_s, sliding
    return v, v
