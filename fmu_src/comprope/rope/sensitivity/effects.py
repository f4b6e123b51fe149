"""Directional derivative of the forces of effects: by differences, whatever the effects are.

Their forces alone are evaluated in the present state, and again in one a small step away: an effect that the model is
without begins with the direction, where there is nothing to subtract. A rope's elongation is some 1e-5 of its element's
length, itself a difference of positions of tens of metres; so segments are moved to first order from where they are, and
the difference keeps its figures however small it is.
"""

from typing import NamedTuple

from ...kernels.jit import kernel
from ..mechanics.axial_law import axial_force
from ..mechanics.effect_hooks import all_forces, all_moments
from ..mechanics.internal_forces import bend
from ..parameters.parameter_vector import CA, EA, ELEMENT, R
from ..runtime.array_layout import FX, INVERSE, MOMENT, SPIN, TENSION, TX, TY
from ..runtime.kernel_arguments import Array, Motion
from ..runtime.simd import LANES
from .directions import difference_step, first_entry, shift_parameters

# How effects take part along a direction, beside rope and contact: not at all; effects begin with the direction; effects
# of the model change; they change, and so does their history.
NO_EFFECTS, NEW_EFFECTS, CHANGED_EFFECTS, CHANGED_HISTORY = range(4)


class EffectForces(NamedTuple):
    """What the evaluation of effects alone works with: it sets f [N], h1 and power [W]."""

    w: Array
    f: Array
    h0: Array  # history before the step
    h1: Array  # history after it
    power: Array


@kernel
def effect_forces(n, t, p, motion, w, result):
    """Set the forces of effects alone in a state whose segments and nodes are in result.w; w is that of the present state.

    Moments M of theirs act as the shear Q = (M_e - M_e+1) / L of each segment as it is at present: how a segment that
    turns carries its shear along is the rope's own part (see `internal_forces`). result.w loses its own moments, and what
    its section FX held to those shears.
    """
    m, w1, f = n + 1, result.w, result.f
    for i in range(n):
        w1[MOMENT * m + i] = 0.0
    all_moments(n, p, w1, result.h0, result.h1, result.power)
    for e in range(n - 1):
        w1[FX * m + e] = (w1[MOMENT * m + e] - w1[MOMENT * m + e + 1]) * w[INVERSE * m + e]
    f[0], f[m] = -w1[FX * m] * w[TY * m], w1[FX * m] * w[TX * m]
    for i in range(1, n - 1):
        f[i] = w1[FX * m + i - 1] * w[TY * m + i - 1] - w1[FX * m + i] * w[TY * m + i]
    for i in range(1, n - 1):
        f[m + i] = w1[FX * m + i] * w[TX * m + i] - w1[FX * m + i - 1] * w[TX * m + i - 1]
    f[n - 1], f[m + n - 1] = w1[FX * m + n - 2] * w[TY * m + n - 2], -w1[FX * m + n - 2] * w[TX * m + n - 2]
    f[n], f[m + n] = 0.0, 0.0
    all_forces(n, t, p, motion.q, motion.v, w1, f, result.power)


@kernel
def present_effect_forces(rope, t, state, work, directions):
    """Set directions.work.f1 to the forces of effects in the present state, and work.history to what becomes of theirs."""
    own = EffectForces(work.w, directions.work.f1, directions.work.history_before, work.history, work.power)
    effect_forces(rope.n, t, rope.p, Motion(state.q, state.v, state.a), work.w, own)


@kernel
def add_lane(n, factor, f, b, D):
    """Add `factor` times the forces f to the direction whose entries of D begin at b."""
    m = n + 1
    for i in range(m):
        D[b + 2 * LANES * i] += factor * f[i]
        D[b + (2 * i + 1) * LANES] += factor * f[m + i]


@kernel
def stretch_by_moves(n, p, l0, w0, e0, moves, v, w):
    """What `internal_forces.stretch` gives after small moves, to first order, from w0, e0 and elements of length l0."""
    m, l = n + 1, p[ELEMENT]
    longer, per_l = l - l0, 1.0 / l
    for e in range(n - 1):
        tx, ty, inverse = w0[TX * m + e], w0[TY * m + e], w0[INVERSE * m + e]
        ax, ay = moves[e + 1] - moves[e], moves[m + e + 1] - moves[m + e]
        vx, vy = v[e + 1] - v[e], v[m + e + 1] - v[m + e]
        along, tilt = tx * ax + ty * ay, (tx * ay - ty * ax) * inverse
        cx, cy, shorter = tx - tilt * ty, ty + tilt * tx, inverse - along * inverse * inverse
        w[TX * m + e] = cx
        w[TY * m + e] = cy
        w[INVERSE * m + e] = shorter
        w[TENSION * m + e] = axial_force(p, (p[EA] * (e0[e] + along - longer) + p[CA] * (cx * vx + cy * vy)) * per_l)[0]
        w[SPIN * m + e] = (cx * vy - cy * vx) * shorter


@kernel
def move_nodes(m, k, e, h, state, motion, directions):
    """Set `motion` to positions and velocities a step e along direction k, predicted h ahead."""
    b, dq, dv, da, moves = first_entry(m, k), directions.dq, directions.dv, directions.da, directions.work.moves
    for i in range(m):
        for c in range(2):
            entry, j = b + (2 * i + c) * LANES, c * m + i
            moves[j] = e * (dq[entry] + h * (dv[entry] + 0.5 * h * da[entry]))
            motion.q[j], motion.v[j] = state.q[j] + moves[j], state.v[j] + e * (dv[entry] + h * da[entry])


@kernel
def any_changed_effects(directions):
    """Whether effects of the model change along some direction."""
    found = False
    for k in range(directions.number):
        found = found or directions.effects_mode[k] >= CHANGED_EFFECTS
    return found


@kernel
def set_history(size, k, e, directions):
    """Set the history with which direction k is evaluated: the rope's own, changed, or that of effects that begin."""
    h0, dh, target = directions.work.history_before, directions.dh, directions.work.history_in
    for i in range(size):
        change = dh[size * k + i]
        target[i] = change if directions.new_history[k] != 0.0 else h0[i] + e * change


@kernel
def keep_history(size, k, e, own, directions):
    """Keep direction k's history of a step in which the rope's own history became `own`."""
    dh, found = directions.dh, directions.work.history_out
    for i in range(size):
        dh[size * k + i] = found[i] if directions.new_history[k] != 0.0 else (found[i] - own[i]) / e


@kernel
def effects_along(rope, t, k, h, state, motion, work, directions):
    """Set work.f to the forces of effects a step along direction k, predicted h ahead, and their history; returns that step."""
    n, p, beside = rope.n, rope.p, directions.work
    e = difference_step(n, p[R], directions, k)
    shift_parameters(directions, k, e)
    set_history(rope.history_size, k, e, directions)
    if directions.effects_mode[k] == NEW_EFFECTS:
        found = EffectForces(work.w, work.f, beside.history_in, beside.history_out, work.power)
        effect_forces(n, t, beside.p1, Motion(state.q, state.v, state.a), work.w, found)
    else:
        move_nodes(n + 1, k, e, h, state, motion, directions)
        stretch_by_moves(n, beside.p1, p[ELEMENT], work.w, beside.elongations, beside.moves, motion.v, beside.w1)
        bend(n, beside.p1, beside.w1)
        found = EffectForces(beside.w1, work.f, beside.history_in, beside.history_out, work.power)
        effect_forces(n, t, beside.p1, motion, work.w, found)
    return e


@kernel
def advance_histories(rope, t, state, motion, work, directions):
    """Keep the histories that changed over a step, as the state it reached makes them."""
    for k in range(directions.number):
        if directions.effects_mode[k] == CHANGED_HISTORY:
            e = effects_along(rope, t, k, 0.0, state, motion, work, directions)
            keep_history(rope.history_size, k, e, work.history, directions)
