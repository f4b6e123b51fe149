"""The state at the start: a rope at rest between its ends, from an initial guess to static equilibrium."""

from math import cos, pi, sin

from ...kernels.jit import kernel
from ..mechanics.effect_hooks import all_begin
from ..mechanics.end_conditions import PATH, PATHS, place_ends_of_state
from ..mechanics.energy import begin_balance
from ..mechanics.equations_of_motion import forces_of_state
from ..mechanics.run_record import record_step, slack_segments
from ..mechanics.wall_motion import clear_wall_motion, set_wall_motion
from ..parameters.parameter_vector import ELEMENT, HEIGHT, PIT, RATIO, R
from ..runtime.kernel_arguments import Ends, Motion, RopeData, State, Weights, Workspace
from ..runtime.status import NO_EQUILIBRIUM, OUT_OF_PLACE, OUT_OF_REACH, SUCCESS
from .inputs import CAR, CAR_OUT, COUNTERWEIGHT, COUNTERWEIGHT_OUT
from .mesh import MASS, rope_length
from .newmark import copy
from .static_equilibrium import solve_equilibrium

LARGEST_LIFT = 1.0  # m, of the axle at the start, from where it is built: ropes stretch by centimetres, pits are metres deep


@kernel
def check_reach(rope: RopeData, ends: Ends, work: Workspace, t: float) -> int:
    """Refuse ends between which the rope cannot hang; returns SUCCESS or the kind of refusal."""
    p, u, message = rope.p, ends.u, work.message
    length = rope_length(p)
    lowest = 0.5 * (u[CAR] + u[COUNTERWEIGHT] - (length - pi * p[R]))
    if min(u[CAR], u[COUNTERWEIGHT]) - lowest >= p[R]:
        return SUCCESS
    message[0], message[1], message[2] = u[CAR], u[COUNTERWEIGHT], t
    message[3], message[4], message[5] = length, lowest, p[R]
    return OUT_OF_REACH


@kernel
def check_start(rope: RopeData, ends: Ends, work: Workspace) -> int:
    """Refuse ends between which the axle would hang far from where it is built; returns SUCCESS or the kind of refusal."""
    p, u, message = rope.p, ends.u, work.message
    lifted = 0.5 * (u[CAR] + u[COUNTERWEIGHT] - p[HEIGHT])
    if abs(lifted) <= LARGEST_LIFT:
        return SUCCESS
    message[0], message[1] = u[CAR], u[COUNTERWEIGHT]
    message[2], message[3], message[4] = lifted - p[PIT], -p[PIT], LARGEST_LIFT
    return OUT_OF_PLACE


@kernel
def initial_guess(n, p, u, q):
    """Set q to straight sides and a half circle that hold the natural length."""
    m, radius = n + 1, p[R]
    axle = 0.5 * (rope_length(p) - pi * radius - u[CAR] - u[COUNTERWEIGHT])
    left = u[CAR] + axle
    for i in range(n):
        s = i * p[ELEMENT]
        turned = min(max((s - left) / radius, 0.0), pi)
        q[i] = s - u[CAR] if s < left else axle + radius * sin(turned)
        if s > left + pi * radius:
            q[i] = axle - (s - left - pi * radius)
        q[m + i] = -radius * cos(turned)
    q[n] = axle
    q[m + n] = 0.0


@kernel
def fix_ends(p, u, path):
    """Set a path on which the ends stay where they are."""
    for k in range(PATHS * PATH):
        path[k] = 0.0
    for k in (0, 3):
        path[k] = -u[CAR]
        path[PATH + k] = -p[R] - u[CAR_OUT]
        path[2 * PATH + k] = -u[COUNTERWEIGHT]
        path[3 * PATH + k] = p[R] + u[COUNTERWEIGHT_OUT]


@kernel
def start_at_rest(rope: RopeData, ends: Ends, state: State, work: Workspace, t: float) -> int:
    """Bring a rope whose state is all zero to static equilibrium; returns SUCCESS or the kind of failure."""
    n, p, u, q, v, a = rope.n, rope.p, ends.u, state.q, state.v, state.a
    initial_guess(n, p, u, q)
    fix_ends(p, u, ends.path)
    place_ends_of_state(rope, ends, state, t, 1.0, 0.0)
    set_wall_motion(p, ends.path, 1.0, 0.0)
    set_wall_motion(rope.frictionless, ends.path, 1.0, 0.0)
    for i in range(2 * (n + 1)):
        v[i] = 0.0
        a[i] = 0.0
    if solve_equilibrium(n, rope.frictionless, Motion(q, v, a), state.history, work) < 0.0:
        work.message[0], work.message[1], work.message[2] = u[CAR], u[COUNTERWEIGHT], p[MASS]
        return NO_EQUILIBRIUM
    ratio = p[RATIO]
    p[RATIO] = ratio if slack_segments(n, p, work.w) > 0 else 1.0  # as in the steps to come
    for k in range(2):  # once for the shape where histories begin, once with them
        forces_of_state(rope, state, work, t, Weights(0.0, 0.0), False)
        if k == 0:
            all_begin(n, p, work.w, state.history)
    copy(2 * (n + 1), work.f, state.f)
    begin_balance(rope, state, work)
    record_step(n, t, 0.0, p, q, work.w, state.record)
    p[RATIO] = ratio
    clear_wall_motion(p)
    return SUCCESS
