"""What a drive refuses, one check by its number at a time, so that all problems can be told together."""

from math import isfinite

from ...kernels.jit import kernel
from ...kernels.status import SUCCESS
from ..parameters.parameter_checks import check_curve, check_impulses, check_smoothing, check_stops
from ..status import (
    BRAKE_OUTSIDE,
    CALL_OUTSIDE,
    CAR_NOT_FINITE,
    COUNTERWEIGHT_NOT_FINITE,
    GEAR_OUTSIDE,
    TOO_EARLY,
    TOO_WEAK,
    UNSTABLE,
)
from .arguments import BRAKE, CAR_TENSION, COUNTERWEIGHT_TENSION, DESTINATION, SAFETY_GEAR, Inputs, Parameters, Workspace
from .design import closed_loop_radius
from .hoist import force_at_rest
from .parameter_vector import (
    FIRST_DESTINATION,
    FIRST_START,
    HEIGHT,
    IMPULSE_COUNT,
    POSITION_BANDWIDTH,
    RADIUS,
    ROPES,
    SAMPLE_PERIOD,
    SHARES,
    SMOOTHING_TIME,
    SPEED_BANDWIDTH,
    SPEED_DAMPING,
    START_POSITION,
    TORQUE_LIMIT,
)

# Numbers of the checks: of single components, of all parameters, of inputs, and of the equilibrium at the start.
COMPONENT_CHECKS, STOPS, INPUT_CHECKS, START_CHECK, TORQUE_CHECK, GAIN_CHECK, CHECKS = 0, 3, 4, 9, 10, 11, 12


@kernel
def check(parameters: Parameters, inputs: Inputs, work: Workspace, number: int, t: float) -> int:
    """The status of one check, at the time t [s]."""
    p, u, message = parameters.p, inputs.u, work.message
    if number == 0:
        return check_smoothing(p[SMOOTHING_TIME], message)
    if number == 1:
        return check_curve(p, SHARES, message)
    if number == 2:
        return check_impulses(p[IMPULSE_COUNT], message)
    if number == STOPS:
        return check_stops(p[START_POSITION], p[FIRST_DESTINATION], p[HEIGHT], message)
    if number == START_CHECK:
        message[0], message[1] = p[FIRST_START], t
        return TOO_EARLY if p[FIRST_START] < t else SUCCESS
    if number == TORQUE_CHECK:
        return check_torque(p, u, message)
    if number == GAIN_CHECK:
        return _check_gains(p, work.matrices, message)
    return _check_input(p, u, number - INPUT_CHECKS, message)


@kernel
def _check_input(p, u, number, message):
    if number == 0:
        message[0] = u[CAR_TENSION]
        return SUCCESS if isfinite(u[CAR_TENSION]) else CAR_NOT_FINITE
    if number == 1:
        message[0] = u[COUNTERWEIGHT_TENSION]
        return SUCCESS if isfinite(u[COUNTERWEIGHT_TENSION]) else COUNTERWEIGHT_NOT_FINITE
    if number == 3:
        message[0] = u[BRAKE]
        return SUCCESS if 0.0 <= u[BRAKE] <= 1.0 else BRAKE_OUTSIDE
    if number == 4:
        message[0] = u[SAFETY_GEAR]
        return SUCCESS if 0.0 <= u[SAFETY_GEAR] <= 1.0 else GEAR_OUTSIDE
    message[0], message[1] = u[DESTINATION], p[HEIGHT]
    return SUCCESS if 0.0 <= u[DESTINATION] <= p[HEIGHT] else CALL_OUTSIDE


@kernel
def check_torque(p, u, message):
    """The motor can hold the car at the start."""
    car, counterweight = p[ROPES] * u[CAR_TENSION], p[ROPES] * u[COUNTERWEIGHT_TENSION]
    needed = abs(force_at_rest(p, p[START_POSITION], car, counterweight)) * p[RADIUS]
    message[0], message[1] = p[TORQUE_LIMIT], needed
    return SUCCESS if p[TORQUE_LIMIT] > needed else TOO_WEAK


@kernel
def _check_gains(p, M, message):
    """The closed loop is stable with the car at the bottom, in the middle and at the top."""
    found = 0
    message[0], message[1] = p[POSITION_BANDWIDTH], p[SPEED_BANDWIDTH]
    message[2], message[3] = p[SPEED_DAMPING], p[SAMPLE_PERIOD]
    for k in range(3):
        position = 0.5 * k * p[HEIGHT]
        if not closed_loop_radius(p, position, M) < 1.0:
            message[4 + found] = position
            found += 1
    return UNSTABLE + found - 1 if found else SUCCESS
