"""Design of the drive from its parameters: servo gains, sampled hoist, stability. The tests compare it with python-control's.

The closed forms are those of `servo_control` and `scheduled_plant`.
"""

from math import ceil, exp, log1p

from ...kernels.jit import kernel
from .arguments import (
    FEEDFORWARD,
    FORCE,
    GAIN,
    INPUT_GAIN,
    MATRIX,
    OUTPUT_GAIN,
    RATES,
    ROW,
    T_C,
    T_W,
    V_C,
    V_S,
    V_W,
    Design,
    Parameters,
    S,
    Workspace,
)
from .hoist import hoist_matrix, total_mass
from .matrices import exponential, spectral_radius
from .parameter_vector import (
    ACCELERATION_FEEDFORWARD,
    HEADROOM,
    HEIGHT,
    POSITION_BANDWIDTH,
    SAMPLE_PERIOD,
    SPEED_BANDWIDTH,
    SPEED_DAMPING,
)

RATIO_STEP = 0.01  # change of the logarithm of the ratio of the rope lengths between operating points
_LOOP = 7  # states of the closed loop: those of the hoist that the encoder sees, and the integral
_SEEN = (S, V_S, V_C, V_W, T_C, T_W)


@kernel
def count_points(parameters: Parameters) -> int:
    """Number of operating points."""
    p = parameters.p
    return 2 * ceil(log1p(p[HEIGHT] / p[HEADROOM]) / RATIO_STEP) + 1


@kernel
def operating_position(p, points, i):
    """Car position [m] of an operating point: the logarithms of the ratio of the rope lengths are equally spaced."""
    end = log1p(p[HEIGHT] / p[HEADROOM])
    logarithm = end if i == points - 1 else -end + i * (2.0 * end / (points - 1))
    return (2.0 * p[HEADROOM] + p[HEIGHT]) / (1.0 + exp(-logarithm)) - p[HEADROOM]


@kernel
def servo_gains(p):
    """Pole placement on rigid ropes, by Tustin's rule: force = gain e + output_gain z, next z = z + period e."""
    mass, bandwidth = total_mass(p), p[SPEED_BANDWIDTH]
    integral = bandwidth * bandwidth * mass
    return 2.0 * p[SPEED_DAMPING] * bandwidth * mass + 0.5 * p[SAMPLE_PERIOD] * integral, integral


@kernel
def advance_matrix(rates, at, duration, M):
    """Write the matrix (11, 11) that advances states and inputs by `duration` [s] to M[MATRIX], from rates (8, 11) or more."""
    for k in range(MATRIX):
        M[k] = duration * rates[at + k] if k < RATES else 0.0
    exponential(ROW, M, 0, M, MATRIX, 2 * MATRIX, 4 * MATRIX)


@kernel
def design_drive(parameters: Parameters, design: Design, work: Workspace) -> None:
    """Fill in gains, operating points and the matrices of each; `points` must be that of `count_points`."""
    p, M, points = parameters.p, work.matrices, design.points
    design.gains[GAIN], design.gains[OUTPUT_GAIN] = servo_gains(p)
    design.gains[INPUT_GAIN] = p[SAMPLE_PERIOD]
    design.gains[FEEDFORWARD] = p[ACCELERATION_FEEDFORWARD] * total_mass(p)
    for i in range(points):
        position = operating_position(p, points, i)
        hoist_matrix(p, position, M, 3 * MATRIX)
        for k in range(RATES):
            design.rates[RATES * i + k] = M[3 * MATRIX + k]
        advance_matrix(M, 3 * MATRIX, p[SAMPLE_PERIOD], M)
        for k in range(RATES):
            design.steps[RATES * i + k] = M[MATRIX + k]
        following = operating_position(p, points, min(i + 1, points - 1))
        design.boundaries[i] = 0.5 * (following + position)


@kernel
def _seen(k):
    return _SEEN[k]


@kernel
def closed_loop_radius(p, position, M):
    """Largest absolute value of the closed loop's poles with the car at a position [m]; stable below one."""
    gain, integral = servo_gains(p)
    period = p[SAMPLE_PERIOD]
    hoist_matrix(p, position, M, 3 * MATRIX)
    advance_matrix(M, 3 * MATRIX, period, M)
    loop, last = 3 * MATRIX, _LOOP - 1
    for i in range(_LOOP):
        for j in range(_LOOP):
            M[loop + _LOOP * i + j] = 0.0
    for i in range(last):
        force = M[MATRIX + ROW * _seen(i) + FORCE]
        for j in range(last):
            M[loop + _LOOP * i + j] = M[MATRIX + ROW * _seen(i) + _seen(j)]
        M[loop + _LOOP * i] -= force * gain * p[POSITION_BANDWIDTH]
        M[loop + _LOOP * i + 1] -= force * gain
        M[loop + _LOOP * i + last] = force * integral
    M[loop + _LOOP * last] = -period * p[POSITION_BANDWIDTH]
    M[loop + _LOOP * last + 1] = -period
    M[loop + _LOOP * last + last] = 1.0
    return spectral_radius(_LOOP, M, loop, 0, 4 * MATRIX)
