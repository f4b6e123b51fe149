"""The drive's outputs, in the order of their variables."""

from ...kernels.jit import kernel
from .arguments import (
    BEGIN,
    CAR_ACCELERATION,
    COUNTERWEIGHT_ACCELERATION,
    FORCE,
    POINT,
    RATES,
    REALS,
    ROW,
    SLIP,
    TRIPPED,
    V_C,
    V_W,
    X_C,
    X_W,
    Design,
    Outputs,
    Parameters,
    S,
    State,
)
from .clock import now
from .hoist import rest_force
from .parameter_vector import HEIGHT, RADIUS, START_POSITION
from .reference.shaped_trip import reference_at, reference_end
from .tripped_hoist import hoist_tensions


@kernel
def evaluate_drive(parameters: Parameters, state: State, design: Design, outputs: Outputs) -> None:
    """All outputs at the time reached."""
    p, trip, vector, y = parameters.p, state.trip, state.vector, outputs.y
    time, start, at = now(p, state.clock), p[START_POSITION], RATES * int(state.clock[POINT])
    y[0], y[1] = start + vector[X_C], vector[V_C]
    y[3], y[4] = p[HEIGHT] - start + vector[X_W], vector[V_W]
    y[2], y[5] = 0.0, 0.0
    for k in range(ROW):
        y[2] += design.rates[at + ROW * V_C + k] * vector[k]
        y[5] += design.rates[at + ROW * V_W + k] * vector[k]
    if state.emergency[TRIPPED] != 0.0:
        y[2], y[5] = state.emergency[CAR_ACCELERATION], state.emergency[COUNTERWEIGHT_ACCELERATION]
    y[6] = start + vector[S]
    y[7] = p[RADIUS] * (rest_force(p, state.servo) + vector[FORCE])
    y[8], y[9], y[10], _ = reference_at(trip, time)
    tension, other = hoist_tensions(p, state.servo, vector)
    y[11], y[12], y[13] = max(tension, 0.0), max(other, 0.0), state.emergency[SLIP]
    end = reference_end(trip)
    y[REALS] = 1.0 if trip[BEGIN] <= time < end else 0.0
    y[REALS + 1] = 1.0 if time >= end else 0.0
    y[REALS + 2] = 1.0 if state.emergency[TRIPPED] != 0.0 else 0.0
    y[REALS + 3] = 1.0 if state.emergency[TRIPPED] != 0.0 and min(tension, other) <= 0.0 else 0.0
