"""The hoist's equations of motion about a car position; see `hoist_dynamics`, which has them for python-control."""

from ...kernels.jit import kernel
from .arguments import F_C, F_W, FORCE, MATRIX, REST_CAR, REST_COUNTERWEIGHT, ROW, T_C, T_W, V_C, V_S, V_W, X_C, X_W, S
from .parameter_vector import (
    CAR_MASS,
    COUNTERWEIGHT_MASS,
    DAMPING,
    GRAVITY,
    HEADROOM,
    HEIGHT,
    INERTIA,
    RADIUS,
    ROPE_MASS,
    START_POSITION,
    STIFFNESS,
)


@kernel
def lumped_masses(p, position):
    """Rope lengths [m] on both sides, and moving masses [kg] of sheave, car and counterweight."""
    car_rope, counterweight_rope = p[HEADROOM] + p[HEIGHT] - position, p[HEADROOM] + position
    half = 0.5 * p[ROPE_MASS]
    sheave = p[INERTIA] / (p[RADIUS] * p[RADIUS]) + half * (car_rope + counterweight_rope)
    return (
        car_rope,
        counterweight_rope,
        sheave,
        p[CAR_MASS] + half * car_rope,
        p[COUNTERWEIGHT_MASS] + half * counterweight_rope,
    )


@kernel
def total_mass(p):
    """Total moving mass [kg], the machine's inertia as mass at the rim; independent of the car position."""
    _, _, sheave, car, counterweight = lumped_masses(p, 0.0)
    return sheave + car + counterweight


@kernel
def force_at_rest(p, position, car_pull, counterweight_pull):
    """Force at the rim [N] that holds the car at a position [m]; the pulls [N] are those of all compensation ropes."""
    car_rope, counterweight_rope, _, _, _ = lumped_masses(p, position)
    ropes = p[ROPE_MASS] * (car_rope - counterweight_rope)
    return p[GRAVITY] * (p[CAR_MASS] - p[COUNTERWEIGHT_MASS] + ropes) + car_pull - counterweight_pull


@kernel
def rest_force(p, servo):
    """The force at the rim that holds the hoist in the equilibrium at the start [N]."""
    return force_at_rest(p, p[START_POSITION], servo[REST_CAR], servo[REST_COUNTERWEIGHT])


@kernel
def hoist_matrix(p, position, A, a):
    """Write the matrix (11, 11) of derivatives of states and inputs; the inputs are constant."""
    car_rope, counterweight_rope, sheave, car, counterweight = lumped_masses(p, position)
    weight = p[ROPE_MASS] * p[GRAVITY]
    for k in range(MATRIX):
        A[a + k] = 0.0
    A[a + ROW * S + V_S] = A[a + ROW * X_C + V_C] = A[a + ROW * X_W + V_W] = 1.0
    A[a + ROW * T_C + V_S] = p[STIFFNESS] / car_rope - 0.5 * weight
    A[a + ROW * T_C + V_C] = -p[STIFFNESS] / car_rope
    A[a + ROW * T_W + V_S] = -p[STIFFNESS] / counterweight_rope + 0.5 * weight
    A[a + ROW * T_W + V_W] = -p[STIFFNESS] / counterweight_rope
    car_damping, counterweight_damping = p[DAMPING] / car_rope, p[DAMPING] / counterweight_rope
    row = a + ROW * V_S
    A[row + S], A[row + T_C], A[row + T_W], A[row + FORCE] = weight / sheave, -1.0 / sheave, 1.0 / sheave, 1.0 / sheave
    A[row + V_S] = -(car_damping + counterweight_damping) / sheave
    A[row + V_C], A[row + V_W] = car_damping / sheave, -counterweight_damping / sheave
    row = a + ROW * V_C
    A[row + S], A[row + T_C], A[row + F_C] = 0.5 * weight / car, 1.0 / car, -1.0 / car
    A[row + V_S], A[row + V_C] = car_damping / car, -car_damping / car
    row = a + ROW * V_W
    A[row + S], A[row + T_W], A[row + F_W] = -0.5 * weight / counterweight, 1.0 / counterweight, -1.0 / counterweight
    A[row + V_S] = A[row + V_W] = -counterweight_damping / counterweight
