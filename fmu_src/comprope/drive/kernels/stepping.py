"""Time simulation of the drive: sampled controller and exactly discretised hoist.

The controller samples at start + count * period, independently of the communication step. Between samples the motor torque
is constant and the hoist is integrated exactly, so that communication steps only determine when inputs are read.
"""

from ...kernels.jit import kernel
from ...kernels.status import SUCCESS
from ..status import LEFT_SHAFT, TOO_MANY_PERIODS, TRIPPED_OUTSIDE
from .arguments import (
    BRAKE,
    CALLED,
    CAR_TENSION,
    CHAIN_OPEN,
    CLOCK,
    COUNTERWEIGHT_TENSION,
    DESTINATION,
    ELAPSED,
    EMERGENCY,
    END,
    F_C,
    F_W,
    FEEDFORWARD,
    FORCE,
    GAIN,
    INPUT_GAIN,
    INTEGRAL,
    MATRIX,
    MOTOR_OFF,
    OUTPUT_GAIN,
    PERIODS,
    POINT,
    RATES,
    REST_CAR,
    REST_COUNTERWEIGHT,
    ROW,
    SAFETY_GEAR,
    SERVO,
    START_TIME,
    STATES,
    TRIPPED,
    V_S,
    X_C,
    X_W,
    Design,
    Inputs,
    Parameters,
    S,
    State,
    Workspace,
)
from .checks import check_torque
from .clock import now
from .design import advance_matrix
from .hoist import rest_force
from .parameter_vector import (
    BUFFER_CLEARANCE,
    BUFFER_DECELERATION,
    BUFFER_STIFFNESS,
    FIRST_DESTINATION,
    FIRST_START,
    HEADROOM,
    HEIGHT,
    OVERRUN,
    POSITION_BANDWIDTH,
    RADIUS,
    ROPES,
    SAMPLE_PERIOD,
    START_POSITION,
    TORQUE_LIMIT,
    VELOCITY_FEEDFORWARD,
)
from .reference.shaped_trip import plan_trip, reference_at, reference_end
from .tripped_hoist import advance_tripped, rope_position

SAME_TIME = 1e-6  # times closer than this fraction of a sample period are equal: importers accumulate steps
SPARE_AFTER_TRIP = 0.9  # of the headroom, beyond both landings: so much rope is left
MOST_PERIODS = 1e6  # of the controller in one communication step: a second of computation


@kernel
def operating_point(design, position):
    """Index of the operating point for a car position [m]; the outermost ones are used for all positions beyond them."""
    low, high = 0, design.points - 1
    while low < high:
        middle = (low + high) // 2
        if position < design.boundaries[middle]:
            high = middle
        else:
            low = middle + 1
    return low


@kernel
def overrun_end(p):
    """Where the first trip ends [m]: at its destination, or beyond where the drive fails to stop."""
    start, end = p[START_POSITION], p[FIRST_DESTINATION]
    return end + p[OVERRUN] if end > start else end - p[OVERRUN] if end < start else end


@kernel
def start_at_rest(parameters: Parameters, inputs: Inputs, state: State, design: Design, t: float) -> None:
    """The equilibrium at the time t [s], the motor holding car and counterweight against the tensions among the inputs."""
    p, u, servo = parameters.p, inputs.u, state.servo
    for k in range(CLOCK):
        state.clock[k] = 0.0
    for k in range(SERVO):
        servo[k] = 0.0
    for k in range(ROW):
        state.vector[k] = 0.0
    state.clock[START_TIME], state.clock[POINT] = t, operating_point(design, p[START_POSITION])
    servo[CALLED] = u[DESTINATION]
    servo[REST_CAR], servo[REST_COUNTERWEIGHT] = p[ROPES] * u[CAR_TENSION], p[ROPES] * u[COUNTERWEIGHT_TENSION]
    for k in range(EMERGENCY):
        state.emergency[k] = 0.0
    plan_trip(p, state.trip, p[FIRST_START], p[START_POSITION], overrun_end(p))


@kernel
def advance_drive(
    parameters: Parameters, inputs: Inputs, state: State, design: Design, work: Workspace, t: float, dt: float
) -> int:
    """Advance from t to t + dt [s] with inputs held; returns a status.

    The equilibrium at the start is that with the first tensions that are not zero: not every importer propagates tensions
    during initialization, and no rope is without.
    """
    p, u, clock, period = parameters.p, inputs.u, state.clock, parameters.p[SAMPLE_PERIOD]
    if dt > MOST_PERIODS * period:
        work.message[0], work.message[1] = dt, MOST_PERIODS * period
        return TOO_MANY_PERIODS
    status = _set_pulls(p, u, state, work.message)
    if status != SUCCESS:
        return status
    end, same = t + dt - clock[START_TIME], SAME_TIME * period
    while end - (clock[PERIODS] * period + clock[ELAPSED]) > same:
        _trip(u, state.emergency)
        if clock[ELAPSED] == 0.0:
            status = _check_place(p, state, work.message)
            if status == SUCCESS and state.emergency[TRIPPED] == 0.0:
                status = _run_controller(p, u, state, design, work.message)
            if status != SUCCESS:
                return status
        if state.emergency[TRIPPED] != 0.0:
            _advance_without_motor(p, u, state, end - clock[PERIODS] * period)
        else:
            _advance_hoist(p, state, design, work, end - clock[PERIODS] * period)
    return SUCCESS


@kernel
def _set_pulls(p, u, state, message):
    """Take the tensions for loads beyond those of the equilibrium, or for those of the equilibrium if it had none."""
    servo, vector = state.servo, state.vector
    car, counterweight = p[ROPES] * u[CAR_TENSION], p[ROPES] * u[COUNTERWEIGHT_TENSION]
    without = servo[REST_CAR] == 0.0 and servo[REST_COUNTERWEIGHT] == 0.0
    if without and (car != 0.0 or counterweight != 0.0):
        status = check_torque(p, u, message)
        if status != SUCCESS:
            return status
        servo[REST_CAR], servo[REST_COUNTERWEIGHT] = car, counterweight
    vector[F_C], vector[F_W] = car - servo[REST_CAR], counterweight - servo[REST_COUNTERWEIGHT]
    return SUCCESS


@kernel
def _trip(u, emergency):
    """Switch the motor off for good when brake or safety gear are applied; the gear opens the safety chain as well."""
    if u[SAFETY_GEAR] > 0.0:
        emergency[TRIPPED] = CHAIN_OPEN
    elif u[BRAKE] > 0.0:
        emergency[TRIPPED] = max(emergency[TRIPPED], MOTOR_OFF)


@kernel
def _check_place(p, state, message):
    """After a trip: car and counterweight are where there is rope. Before: one that meets its buffer trips the drive."""
    vector, emergency = state.vector, state.emergency
    car, counterweight = p[START_POSITION] + vector[X_C], p[HEIGHT] - p[START_POSITION] + vector[X_W]
    if emergency[TRIPPED] == 0.0:
        buffers = p[BUFFER_STIFFNESS] > 0.0 or p[BUFFER_DECELERATION] > 0.0
        if buffers and min(car, counterweight) < -p[BUFFER_CLEARANCE]:
            emergency[TRIPPED] = CHAIN_OPEN
        return SUCCESS
    rope, spare = rope_position(p, vector, emergency), SPARE_AFTER_TRIP * p[HEADROOM]
    lowest, highest = min(car, counterweight, rope), max(car, counterweight, rope)
    if -spare <= lowest and highest <= p[HEIGHT] + spare:
        return SUCCESS
    message[0], message[1], message[2] = (lowest if lowest < -spare else highest), now(p, state.clock), p[HEIGHT]
    return TRIPPED_OUTSIDE


@kernel
def _run_controller(p, u, state, design, message):
    """One sample of the controller: accept a call, read the encoder, set the force."""
    clock, servo, trip, vector = state.clock, state.servo, state.trip, state.vector
    time = now(p, clock)
    if time >= reference_end(trip) and u[DESTINATION] != servo[CALLED]:
        plan_trip(p, trip, time, trip[END], u[DESTINATION])
        servo[CALLED] = u[DESTINATION]
    position, spare = p[START_POSITION] + vector[S], 0.5 * p[HEADROOM]
    if not (-spare <= position <= p[HEIGHT] + spare):
        message[0], message[1], message[2], message[3] = position, time, p[HEIGHT], p[TORQUE_LIMIT]
        return LEFT_SHAFT
    clock[POINT] = operating_point(design, position)
    x, v, a, _ = reference_at(trip, time)
    wanted = p[POSITION_BANDWIDTH] * (x - p[START_POSITION] - vector[S]) + p[VELOCITY_FEEDFORWARD] * v
    limit, rest = p[TORQUE_LIMIT] / p[RADIUS], rest_force(p, servo)
    ahead = design.gains[FEEDFORWARD] * a
    vector[FORCE] = servo_force(servo, design.gains, wanted - vector[V_S], ahead, -limit - rest, limit - rest)
    return SUCCESS


@kernel
def servo_force(servo, gains, error, feedforward, low, high):
    """The force at the rim [N] beside that at rest, within the motor's limits; moves the integral of the error [m/s] on.

    While the force is limited, an error of the same sign is not integrated (anti-windup).
    """
    force = gains[GAIN] * error + gains[OUTPUT_GAIN] * servo[INTEGRAL] + feedforward
    limited = min(max(force, low), high)
    if (force - limited) * error <= 0.0:
        servo[INTEGRAL] += gains[INPUT_GAIN] * error
    return limited


@kernel
def _advance_without_motor(p, u, state, until):
    """The same as `_advance_hoist` after a trip."""
    clock, period = state.clock, p[SAMPLE_PERIOD]
    whole = until > period - SAME_TIME * period
    brake = 1.0 if state.emergency[TRIPPED] == CHAIN_OPEN else u[BRAKE]
    advance_tripped(p, state, brake, u[SAFETY_GEAR], (period if whole else until) - clock[ELAPSED])
    if whole:
        clock[PERIODS] += 1.0
    clock[ELAPSED] = 0.0 if whole else until


@kernel
def _advance_hoist(p, state, design, work, until):
    """Integrate the hoist to `until` [s] after the last sample or to the next sample, whichever is first."""
    clock, vector, M, period = state.clock, state.vector, work.matrices, p[SAMPLE_PERIOD]
    at = RATES * int(clock[POINT])
    whole = until > period - SAME_TIME * period
    if whole and clock[ELAPSED] == 0.0:
        apply_matrix(design.steps, at, vector, M)
    else:
        advance_matrix(design.rates, at, (period if whole else until) - clock[ELAPSED], M)
        apply_matrix(M, MATRIX, vector, M)
    if whole:
        clock[PERIODS] += 1.0
    clock[ELAPSED] = 0.0 if whole else until


@kernel
def apply_matrix(A, a, vector, M):
    """Replace the states in the vector (11,) by A (8, 11) times the vector; M[0] to M[7] are lost."""
    for i in range(STATES):
        total = 0.0
        for j in range(ROW):
            total += A[a + ROW * i + j] * vector[j]
        M[i] = total
    for i in range(STATES):
        vector[i] = M[i]
