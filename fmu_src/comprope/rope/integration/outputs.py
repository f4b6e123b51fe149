"""Outputs of the rope: sensors, forces, motions, the residual of the energy balance and what the simulation has cost."""

from ...kernels.jit import kernel
from ..mechanics.energy import EFFECTS, ENDS_WORK, LOSSES, SPENT, STORED, hold_forces
from ..mechanics.equations_of_motion import forces_of_state
from ..mechanics.run_record import PEAK, SLACK_TIME, TRIP_TIME, TRIPPED, largest_tension, least_tension, slack_segments
from ..mechanics.sensors import find_side_maximum, read_sensor
from ..parameters.parameter_vector import ELEMENT, PIT, R
from ..runtime.array_layout import FORCE_X
from ..runtime.kernel_arguments import Outputs, RopeData, State, Weights, Workspace
from .newmark import HALVED, NEWTON

KINDS, SPENDERS = len(STORED), len(SPENT)
# What `evaluate_outputs` sets after two numbers for each sensor.
OUTPUTS = (
    "sheave_force", "sheave_displacement", "sheave_velocity", "sheave_angle", "sheave_angular_velocity", "car_end_tension",
    "counterweight_end_tension", "car_side_max_displacement", "car_side_max_height", "counterweight_side_max_displacement",
    "counterweight_side_max_height", "energy_residual", "newton_iterations", "halvings",
    "slack_length", "slack_duration", "least_element_tension", "largest_element_tension", "peak_element_tension",
    "limit_switch", "limit_switch_time",
)  # fmt: skip


@kernel
def energy_residual(rope: RopeData, state: State) -> float:
    """Stored energy less its start, less work put in, plus losses [J]."""
    E, stored, lost, worked = state.energy, 0.0, 0.0, 0.0
    for k in range(KINDS):
        stored += E[k]
    for k in range(SPENDERS):
        lost += E[LOSSES + k]
    for k in range(rope.effects):
        worked += E[EFFECTS + k]
    return stored - state.start[0] - E[ENDS_WORK] + lost - worked


@kernel
def read_displacement(rope: RopeData, state: State, outputs: Outputs, side: int, x: float) -> None:
    """Set outputs.reading to what a sensor at depth x on a side reads: see `sensors.read_sensor`."""
    read_sensor(rope.n, state.q, side, x, outputs.reading)


@kernel
def read_side_maximum(rope: RopeData, state: State, outputs: Outputs, side: int) -> None:
    """Set outputs.reading to the largest outward position on a side: see `sensors.find_side_maximum`."""
    find_side_maximum(rope.n, state.q, side, outputs.reading)


@kernel
def read_sensors(n, sensors, p, q, outputs):
    """Set y to (outward displacement [m], 1 if the rope is there) for each of so many sensors."""
    reading, y = outputs.reading, outputs.y
    for k in range(sensors):
        side = 1 if outputs.sensors[2 * k + 1] != 0.0 else -1
        read_sensor(n, q, side, -outputs.sensors[2 * k], reading)
        y[2 * k], y[2 * k + 1] = side * reading[0] - p[R], reading[1]


@kernel
def evaluate_outputs(rope: RopeData, state: State, work: Workspace, outputs: Outputs, sensors: int) -> None:
    """Set y to the readings of so many sensors and then to the values named by OUTPUTS, at the state reached."""
    n, p, q, v, y, reading, P = rope.n, rope.p, state.q, state.v, outputs.y, outputs.reading, work.powers
    read_sensors(n, sensors, p, q, outputs)
    forces_of_state(rope, state, work, state.time[0], Weights(0.0, 0.0), False)
    hold_forces(n, p, state.a, work.f, P)
    b = 2 * sensors
    y[b], y[b + 1], y[b + 2] = -work.contact[FORCE_X], p[PIT] - q[n], -v[n]
    y[b + 3], y[b + 4] = q[2 * n + 1], v[2 * n + 1]
    y[b + 5], y[b + 6] = -P[0], -P[2]
    for k in range(2):
        find_side_maximum(n, q, 2 * k - 1, reading)
        y[b + 7 + 2 * k], y[b + 8 + 2 * k] = reading[0] - p[R], -reading[1]
    y[b + 11] = energy_residual(rope, state)
    y[b + 12], y[b + 13] = state.counters[NEWTON], state.counters[HALVED]
    evaluate_record(n, p, work.w, state.record, y, b + 14)


@kernel
def evaluate_record(n, p, w, record, y, b):
    """Set y from b on to slack [m] and its duration [s], tensions along the rope [N], and the sheave's limit switch."""
    y[b], y[b + 1] = slack_segments(n, p, w) * p[ELEMENT], record[SLACK_TIME]
    y[b + 2], y[b + 3] = least_tension(n, w), largest_tension(n, w)
    y[b + 4] = max(record[PEAK], y[b + 3])
    y[b + 5], y[b + 6] = record[TRIPPED], record[TRIP_TIME]
