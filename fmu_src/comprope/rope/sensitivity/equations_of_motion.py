"""Directional derivative of the right-hand sides of eq. (1) and (2): rope, contact and effects together."""

from ...kernels.jit import kernel
from ..integration.newmark import copy
from ..mechanics.equations_of_motion import forces_of_state
from ..parameters.parameter_vector import R
from ..runtime.kernel_arguments import Directions, Motion, RopeData, State, Weights, Workspace
from ..runtime.simd import LANES
from .directions import difference_step, first_entry, shift_parameters
from .effects import (
    CHANGED_EFFECTS,
    NO_EFFECTS,
    add_lane,
    any_changed_effects,
    effects_along,
    keep_history,
    present_effect_forces,
)
from .internal_forces import Combination, elongations, rope_derivative
from .sheave_contact import centre_derivative, contact_derivative


@kernel
def block_derivative(rope, state, work, directions, block, combination):
    """Set a block of D to the rope's and the contact's part, and its part of `lift` (see `force_derivatives`)."""
    n, p, m, h = rope.n, rope.p, rope.n + 1, combination.h
    dq, dv, da, beside = directions.dq, directions.dv, directions.da, directions.work
    rope_derivative(n, p, state, work.w, directions, block, combination)
    for k in range(block * LANES, min(block * LANES + LANES, directions.number)):
        b = first_entry(m, k) + (2 * n + 1) * LANES
        e = difference_step(n, p[R], directions, k)
        shift_parameters(directions, k, e)
        turned, x = dq[b] + h * (dv[b] + 0.5 * h * da[b]), b - LANES
        moves = dq[x] + h * (dv[x] + 0.5 * h * da[x]), turned
        centre_derivative(e, (p, beside.p1), (state.q[n], state.q[m + n]), moves, k % LANES, beside.centre)
    contact_derivative(n, p, state, work.contact, directions, block, combination)


@kernel
def force_derivatives(rope, t, combination, blocks, state, motion, work, directions):
    """Set D to new D + keep (dc - dM a) for the directions of a range of blocks.

    On the right D is the derivative of the forces, predicted h ahead. Where what the last step has left is kept, histories
    of effects that begin with their direction are too. `lift` are the derivatives of the vertical force on the sheave.
    """
    begin, end = blocks
    D, new = directions.work.D, combination.new
    for block in range(begin, end):
        block_derivative(rope, state, work, directions, block, combination)
    for k in range(begin * LANES, min(end * LANES, directions.number)):
        mode = directions.effects_mode[k]
        if mode != NO_EFFECTS:
            b = first_entry(rope.n + 1, k)
            e = effects_along(rope, t, k, combination.h, state, motion, work, directions)
            add_lane(rope.n, new / e, work.f, b, D)
            if mode >= CHANGED_EFFECTS:
                add_lane(rope.n, -new / e, directions.work.f1, b, D)
            if combination.keep != 0.0 and directions.new_history[k] != 0.0:
                keep_history(rope.history_size, k, e, work.history, directions)


@kernel
def differentiate_forces(
    rope: RopeData, state: State, motion: Motion, work: Workspace, directions: Directions, t: float
) -> None:
    """Set D to the derivative of the forces along all directions, and `lift` to that of the vertical force on the sheave."""
    copy(rope.history_size, state.history, directions.work.history_before)
    forces_of_state(rope, state, work, t, Weights(0.0, 0.0), False)
    elongations(rope.n, rope.p, state.v, work.w, directions.work.elongations)
    if any_changed_effects(directions):
        present_effect_forces(rope, t, state, work, directions)
    force_derivatives(rope, t, Combination(0.0, 1.0, 0.0), (0, directions.blocks), state, motion, work, directions)
