"""The groups of arrays that the drive's kernels take, and what stands where in each array."""

from typing import Any, NamedTuple

from ...kernels.entry_source import Array, Tables
from ..parameters.parameter_checks import INTERVALS

# Of the hoist: states, then inputs (see `hoist_dynamics`); `vector` has both.
S, X_C, X_W, V_S, V_C, V_W, T_C, T_W, FORCE, F_C, F_W = range(11)
STATES, ROW = 8, 11  # of the hoist; states and inputs together
MATRIX = ROW * ROW
RATES = STATES * ROW  # numbers of the matrices of one operating point
DESTINATION, CAR_TENSION, COUNTERWEIGHT_TENSION, BRAKE, SAFETY_GEAR = range(5)  # inputs of the drive
PERIODS, POINT, ELAPSED, START_TIME, CLOCK = range(5)
INTEGRAL, CALLED, REST_CAR, REST_COUNTERWEIGHT, SERVO = range(5)
GAIN, INPUT_GAIN, OUTPUT_GAIN, FEEDFORWARD, GAINS = range(5)
TRIPPED, BRAKE_LEVEL, GEAR_LEVEL, SLIP, SLIP_VELOCITY, CAR_ACCELERATION, COUNTERWEIGHT_ACCELERATION, EMERGENCY = range(8)
MOTOR_OFF, CHAIN_OPEN = 1.0, 2.0  # how it has tripped: by the brake; by safety gear or buffer, which apply the brake as well
REALS = 14  # outputs; four switches follow

IMPULSES_AT_MOST = 3
# A trip: its limits of time and place, the S-curve, the shaping, and the knots of a free-form trip.
BEGIN, ORIGIN, END, DURATION, JERK, RAMP, PLATEAU, CRUISE, FREE, SMOOTHING, IMPULSES, DELAYS = range(12)
WEIGHTS = DELAYS + IMPULSES_AT_MOST
ACCELERATIONS = WEIGHTS + IMPULSES_AT_MOST
SPEEDS = ACCELERATIONS + INTERVALS + 1
DISTANCES = SPEEDS + INTERVALS + 1
INTEGRALS = DISTANCES + INTERVALS + 1
TRIP = INTEGRALS + INTERVALS + 1


class Parameters(NamedTuple):
    """The drive's parameters."""

    p: Array  # see `parameter_vector`


class Inputs(NamedTuple):
    """Inputs: the height called to [m], tensions of one compensation rope [N], and how far brake and safety gear are applied."""

    u: Array


class State(NamedTuple):
    """The complete state of a drive; it can be copied, saved and compared bit for bit."""

    clock: Array  # whole sample periods, operating point, time in the present period [s], start time [s]
    servo: Array  # integral of the speed error [m/s], destination called last [m], forces of the ropes at rest [N]
    trip: Array  # present trip
    vector: Array  # states and inputs of the hoist
    emergency: Array  # whether it has tripped, levels of brake and safety gear, slip [m, m/s], accelerations of the ends [m/s2]


class Design(NamedTuple):
    """Servo gains, and the hoist linearised about operating points; point i is used up to the position `boundaries[i]` [m]."""

    points: int
    gains: Array
    boundaries: Array  # (points - 1), ascending, then one number without meaning
    rates: Array  # for each point a matrix (8, 11): derivatives of the states
    steps: Array  # for each point a matrix (8, 11): states one sample period later


class Workspace(NamedTuple):
    """What kernels compute on the way."""

    matrices: Array  # four matrices (11, 11) and a row
    message: Array  # numbers for the message of a status, see `drive.status`


class Outputs(NamedTuple):
    """All outputs, in their order."""

    y: Array


GROUPS: tuple[Any, ...] = (State, Design, Workspace, Outputs, Parameters, Inputs)
TABLES = Tables(GROUPS)
