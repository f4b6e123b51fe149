"""What a rope shows of itself: sensors, forces, motions, the ledger's residual and what the run has cost."""

from ..mechanics.energy import EFFECTS, ENDS_WORK, LOSSES, SPENT, STORED, hold_forces
from ..mechanics.equations_of_motion import forces
from ..mechanics.sensors import side_maximum, sight
from ..runtime.array_layout import FORCE_X
from ..runtime.jit import kernel
from ..runtime.parameter_vector import PIT, R
from .newmark import HALVED, NEWTON

KINDS, SPENDERS = len(STORED), len(SPENT)
# What `show` sets after two numbers for each sensor.
SHOWN = (
    "sheave_force", "sheave_displacement", "sheave_velocity", "sheave_angle", "sheave_angular_velocity", "car_end_tension",
    "counterweight_end_tension", "car_side_max_displacement", "car_side_max_height", "counterweight_side_max_displacement",
    "counterweight_side_max_height", "energy_residual", "newton_iterations", "halvings",
)  # fmt: skip


@kernel
def residual_energy(E, start, effects):
    """Stored energy less its start, less work put in, plus losses [J]."""
    stored, lost, worked = 0.0, 0.0, 0.0
    for k in range(KINDS):
        stored += E[k]
    for k in range(SPENDERS):
        lost += E[LOSSES + k]
    for k in range(effects):
        worked += E[EFFECTS + k]
    return stored - start[0] - E[ENDS_WORK] + lost - worked


@kernel
def see(n, m, p, q, spots, seen, y):
    """Set y to (outward displacement [m], 1 if the rope is there) for each of m sensors.

    `spots` has for each (height [m], 1 if it looks at the counterweight's side, 0 if at the car's).
    """
    for k in range(m):
        side = 1 if spots[2 * k + 1] != 0.0 else -1
        sight(n, q, side, -spots[2 * k], seen)
        y[2 * k], y[2 * k + 1] = side * seen[0] - p[R], seen[1]


@kernel
def show(n, m, p, spots, q0, v0, a0, h0, f, h1, w, Z, touch, power, P, E, start, count, time, effects, seen, y):
    """Set y to what each of m sensors sees and then to the values named by SHOWN, at the state reached."""
    see(n, m, p, q0, spots, seen, y)
    forces(n, time[0], p, q0, v0, w, f, touch, h0, h1, power, Z, 0.0, 0.0, False)
    hold_forces(n, p, a0, f, P)
    b = 2 * m
    y[b], y[b + 1], y[b + 2] = -touch[FORCE_X], p[PIT] - q0[n], -v0[n]
    y[b + 3], y[b + 4] = q0[2 * n + 1], v0[2 * n + 1]
    y[b + 5], y[b + 6] = -P[0], -P[2]
    for k in range(2):
        side_maximum(n, q0, 2 * k - 1, seen)
        y[b + 7 + 2 * k], y[b + 8 + 2 * k] = seen[0] - p[R], -seen[1]
    y[b + 11] = residual_energy(E, start, effects)
    y[b + 12], y[b + 13] = count[NEWTON], count[HALVED]
