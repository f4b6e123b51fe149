"""Directional derivative of the prescribed motion of the ends: by differences of their paths."""

from ...kernels.jit import kernel
from ..mechanics.end_conditions import PATH, PATHS, place_ends
from ..runtime.simd import LANES
from .directions import first_entry, shift_parameters

ENDS_STEP = 1e-2  # of `max_step`: the difference by which the ends' paths are differentiated


@kernel
def place_ends_of_direction(n, k, path, step, state, motion, directions):
    """Set the ends' part of direction k at the end of a time step; `motion` is free for use.

    What is set is what the predictor, a step ahead, turns into that.
    """
    m, h, e, path1 = n + 1, step.h, ENDS_STEP * directions.max_step[k], directions.work.path1
    shift_parameters(directions, k, e)
    for j in range(PATHS * PATH):
        path1[j] = path[j] + e * directions.dpath[PATHS * PATH * k + j]
    place_ends(n, step.t, directions.work.p1, path1, step.dt, step.s, motion)
    dq, dv, da = directions.dq, directions.dv, directions.da
    for i in (0, n - 1):
        for c in range(2):
            j, b = c * m + i, first_entry(m, k) + (2 * i + c) * LANES
            da[b] = (motion.a[j] - state.a[j]) / e
            dv[b] = (motion.v[j] - state.v[j]) / e - h * da[b]
            dq[b] = (motion.q[j] - state.q[j]) / e - h * dv[b] - 0.5 * h * h * da[b]


@kernel
def place_ends_of_directions(n, path, step, state, motion, directions):
    """Place the ends of all directions that move them."""
    for k in range(directions.number):
        if directions.moves_ends[k] != 0.0:
            place_ends_of_direction(n, k, path, step, state, motion, directions)
