"""The hoist after a trip by brake, safety gear or buffer: motor off, ropes that only pull and slide on the traction sheave.

States and their equations are those of `hoist_dynamics`, with absolute tensions N and these laws in place of its linear ones:

    N = max(0, elastic tension + damping)            a slack rope carries nothing, and has no damping until it is taut
    |f_brake| <= level torque / r                    Coulomb friction at the rim
    -share F <= f_gear <= F = level m_c (g + a)      Coulomb friction on the car, with a share of it against upward motion
    T_1 / T_2 <= e^(f wrap) on the sheave            beyond, the ropes slide; f from groove and speed (EN 81-50)
    buffer: k d and m (g + a) against its compression, at the depth d in it

T are the tensions where the ropes run onto the sheave. Steps of at most SUBSTEP by Newmark's rule with gamma = 1 and beta = 1/2,
forces at the end of a step, as for slack compensation ropes: it moves what falls freely exactly and never puts in energy.
`velocity_balance` finds the velocities at the end of a step.
"""

from math import ceil, cos, exp, pi, sin

from ...kernels.jit import kernel
from .arguments import (
    BRAKE_LEVEL,
    CAR_ACCELERATION,
    COUNTERWEIGHT_ACCELERATION,
    F_C,
    F_W,
    FORCE,
    GEAR_LEVEL,
    REST_CAR,
    REST_COUNTERWEIGHT,
    SLIP,
    SLIP_VELOCITY,
    T_C,
    T_W,
    V_C,
    V_S,
    V_W,
    X_C,
    X_W,
    S,
)
from .hoist import lumped_masses, rest_force
from .parameter_vector import (
    BRAKE_RISE,
    BRAKE_TORQUE,
    BUFFER_CLEARANCE,
    BUFFER_DECELERATION,
    BUFFER_STIFFNESS,
    CAR_MASS,
    COUNTERWEIGHT_MASS,
    DAMPING,
    FRICTION,
    GEAR_DECELERATION,
    GEAR_RISE,
    GEAR_UPWARD,
    GRAVITY,
    GROOVE,
    HEIGHT,
    INERTIA,
    RADIUS,
    ROPE_MASS,
    START_POSITION,
    STIFFNESS,
    UNDERCUT,
    WRAP,
)
from .velocity_balance import pulled_end, velocities_after

SUBSTEP = 1e-4  # s: 1/60 of the period of a stiff hoist at 170 Hz, and far below the time in which a brake takes hold
FRICTION_SPEED = 10.0  # m/s at which the friction coefficient has fallen by half: EN 81-50


@kernel
def groove_friction(p, speed):
    """Friction factor f of the hoist ropes in grooves with undercut at a speed [m/s]: EN 81-50."""
    shape = cos(0.5 * p[GROOVE]) - sin(0.5 * p[UNDERCUT])
    area = pi - p[UNDERCUT] - p[GROOVE] - sin(p[UNDERCUT]) + sin(p[GROOVE])
    return p[FRICTION] / (1.0 + speed / FRICTION_SPEED) * 4.0 * shape / area


@kernel
def traction_limit(p, speed):
    """Largest ratio of the tensions on both sides of the traction sheave at a speed of the ropes [m/s]."""
    return exp(groove_friction(p, speed) * p[WRAP])


@kernel
def rest_tensions(p, servo):
    """Tension [N] of the hoist ropes at car and counterweight at the start, with half of each side's rope."""
    _, _, _, car, counterweight = lumped_masses(p, p[START_POSITION])
    return p[GRAVITY] * car + servo[REST_CAR], p[GRAVITY] * counterweight + servo[REST_COUNTERWEIGHT]


@kernel
def hoist_tensions(p, servo, vector):
    """Elastic tension [N] of the hoist ropes at car and counterweight; negative where they are slack."""
    car, counterweight = rest_tensions(p, servo)
    return car + vector[T_C], counterweight + vector[T_W]


@kernel
def _towards(level, wanted, rise, h):
    """A level that follows its input within a time."""
    if rise <= h:
        return wanted
    return min(wanted, level + h / rise) if wanted > level else max(wanted, level - h / rise)


@kernel
def buffer_load(p, height, mass):
    """Force of the buffer's spring [N] on what is at a height [m] and the largest one that its oil takes up."""
    depth = -height - p[BUFFER_CLEARANCE]
    if depth <= 0.0:
        return 0.0, 0.0
    oil = mass * (p[GRAVITY] + p[BUFFER_DECELERATION]) if p[BUFFER_DECELERATION] > 0.0 else 0.0
    return p[BUFFER_STIFFNESS] * depth, oil


@kernel
def _bodies(p, servo, vector, emergency, h, lengths):
    """Car and counterweight as `pulled_end` takes them, with the lengths [m] and masses [kg] of `lumped_masses`."""
    car_rope, counterweight_rope, _, car, counterweight = lengths
    tension, other = hoist_tensions(p, servo, vector)
    rope, weight = vector[V_S] + emergency[SLIP_VELOCITY], 0.5 * p[ROPE_MASS] * p[GRAVITY] * h
    stiffness, other_stiffness = 0.5 * h * p[STIFFNESS] / car_rope, 0.5 * h * p[STIFFNESS] / counterweight_rope
    viscosity = stiffness + (p[DAMPING] / car_rope if tension > 0.0 else 0.0)
    other_viscosity = other_stiffness + (p[DAMPING] / counterweight_rope if other > 0.0 else 0.0)
    spring, oil = buffer_load(p, p[START_POSITION] + vector[X_C], p[CAR_MASS])
    load = p[GRAVITY] * car + servo[REST_CAR] + vector[F_C] - spring
    gear = emergency[GEAR_LEVEL] * p[CAR_MASS] * (p[GRAVITY] + p[GEAR_DECELERATION])
    other_spring, other_oil = buffer_load(p, p[HEIGHT] - p[START_POSITION] + vector[X_W], p[COUNTERWEIGHT_MASS])
    other_load = p[GRAVITY] * counterweight + servo[REST_COUNTERWEIGHT] + vector[F_W] - other_spring
    pull = tension + stiffness * (rope - vector[V_C]) - weight * rope
    other_pull = other - other_stiffness * (rope + vector[V_W]) + weight * rope
    return (
        (car / h, vector[V_C], load, oil + gear, p[GEAR_UPWARD] * gear, pull, viscosity),
        (counterweight / h, vector[V_W], other_load, other_oil, 0.0, other_pull, other_viscosity),
    )


@kernel
def _move(p, servo, vector, emergency, h, after):
    """Move the states on by h [s] to the velocities `after` of rim, rope, car and counterweight."""
    car_rope, counterweight_rope, _, _, _ = lumped_masses(p, rope_position(p, vector, emergency))
    v_s, v, v_c, v_w = after
    rope = vector[V_S] + emergency[SLIP_VELOCITY]
    emergency[CAR_ACCELERATION], emergency[COUNTERWEIGHT_ACCELERATION] = (v_c - vector[V_C]) / h, (v_w - vector[V_W]) / h
    run, up, other_up = 0.5 * h * (rope + v), 0.5 * h * (vector[V_C] + v_c), 0.5 * h * (vector[V_W] + v_w)
    turned = 0.5 * h * (vector[V_S] + v_s)
    shed = 0.5 * p[ROPE_MASS] * p[GRAVITY] * run
    vector[T_C] += p[STIFFNESS] / car_rope * (run - up) - shed
    vector[T_W] -= p[STIFFNESS] / counterweight_rope * (run + other_up) - shed
    vector[S], vector[X_C], vector[X_W] = vector[S] + turned, vector[X_C] + up, vector[X_W] + other_up
    emergency[SLIP] += run - turned
    vector[V_S], vector[V_C], vector[V_W], emergency[SLIP_VELOCITY] = v_s, v_c, v_w, v - v_s
    tension, other = hoist_tensions(p, servo, vector)
    if tension < 0.0:  # what hangs slack stays as long while the rope runs over the sheave
        vector[T_C] += tension * (car_rope / (car_rope - run) - 1.0)
    if other < 0.0:
        vector[T_W] += other * (counterweight_rope / (counterweight_rope + run) - 1.0)


@kernel
def rope_position(p, vector, emergency):
    """Height [m] at which the car would be on rigid ropes: that of the rim, and what the ropes have slid over it."""
    return p[START_POSITION] + vector[S] + emergency[SLIP]


@kernel
def advance_tripped(p, state, brake, gear, duration):
    """Move the hoist on by a duration [s] with the motor off, brake and safety gear on their way to the levels of the inputs."""
    servo, vector, emergency = state.servo, state.vector, state.emergency
    count = ceil(duration / SUBSTEP)
    h = duration / count
    vector[FORCE] = -rest_force(p, servo)
    inertia = p[INERTIA] / (p[RADIUS] * p[RADIUS])
    for _ in range(int(count)):
        emergency[BRAKE_LEVEL] = _towards(emergency[BRAKE_LEVEL], brake, p[BRAKE_RISE], h)
        emergency[GEAR_LEVEL] = _towards(emergency[GEAR_LEVEL], gear, p[GEAR_RISE], h)
        lengths = lumped_masses(p, rope_position(p, vector, emergency))
        car, counterweight = _bodies(p, servo, vector, emergency, h, lengths)
        v0, half = vector[V_S] + emergency[SLIP_VELOCITY], 0.5 * p[ROPE_MASS]
        rope = (half * lengths[0], half * lengths[1], v0, 1.0 / h, p[GRAVITY])
        sheave = (inertia / h, vector[V_S], emergency[BRAKE_LEVEL] * p[BRAKE_TORQUE] / p[RADIUS])
        ratio = traction_limit(p, abs(v0))
        v_s, v = velocities_after(rope, car, counterweight, sheave, emergency[SLIP_VELOCITY], ratio)
        v_c, _, _ = pulled_end(car, v)
        v_w, _, _ = pulled_end(counterweight, -v)
        _move(p, servo, vector, emergency, h, (v_s, v, v_c, v_w))
