"""Directional derivative of the forces of effects: by differences, whatever the effects are.

Their forces alone are evaluated in the present state, and again in one a small step away: an effect that the model is
without begins with the direction, where there is nothing to subtract. A rope's elongation is some 1e-5 of its element's
length, itself a difference of positions of tens of metres; so segments are moved to first order from where they are, and
the difference keeps its figures however small it is.
"""

from ..mechanics.effect_hooks import all_forces, all_moments
from ..mechanics.internal_forces import bend
from ..runtime.array_layout import FX, INVERSE, MOMENT, SPIN, TENSION, TX, TY
from ..runtime.jit import kernel
from ..runtime.parameter_vector import CA, EA, ELEMENT, R
from ..runtime.simd import LANES
from .directions import entry, gauge, shift

# What effects do along a direction, beside rope and contact: nothing; begin with it; change, as the model has some;
# change, and their history with them.
BY_HAND, BEGUN, DIFFERENCED, CHANGED = range(4)


@kernel
def effect_forces(n, t, p1, q, v, w1, w, f, hi, hd, power):
    """Set f to the forces of effects alone, with parameters p1 in the state (q, v) of w1; w is of the present state.

    Moments M of theirs act as the shear Q = (M_e - M_e+1) / L of each segment as it is at present: how a segment that
    turns carries its shear along is the rope's own part (see `slope`). w1 loses its own moments, and what its section FX
    held to those shears.
    """
    m = n + 1
    for i in range(n):
        w1[MOMENT * m + i] = 0.0
    all_moments(n, p1, w1, hi, hd, power)
    for e in range(n - 1):
        w1[FX * m + e] = (w1[MOMENT * m + e] - w1[MOMENT * m + e + 1]) * w[INVERSE * m + e]
    f[0], f[m] = -w1[FX * m] * w[TY * m], w1[FX * m] * w[TX * m]
    for i in range(1, n - 1):
        f[i] = w1[FX * m + i - 1] * w[TY * m + i - 1] - w1[FX * m + i] * w[TY * m + i]
    for i in range(1, n - 1):
        f[m + i] = w1[FX * m + i] * w[TX * m + i] - w1[FX * m + i - 1] * w[TX * m + i - 1]
    f[n - 1], f[m + n - 1] = w1[FX * m + n - 2] * w[TY * m + n - 2], -w1[FX * m + n - 2] * w[TX * m + n - 2]
    f[n], f[m + n] = 0.0, 0.0
    all_forces(n, t, p1, q, v, w1, f, power)


@kernel
def add_lane(n, factor, f, at, D):
    """Add `factor` times the forces f to the direction whose entries of D begin at `at`."""
    m = n + 1
    for i in range(m):
        D[at + 2 * LANES * i] += factor * f[i]
        D[at + (2 * i + 1) * LANES] += factor * f[m + i]


@kernel
def stretch_on(n, p, l0, w0, e0, moves, v, w):
    """What `elastica.stretch` gives after small moves, to first order; before them w0 and e0 held, and elements of length l0."""
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
        w[TENSION * m + e] = (p[EA] * (e0[e] + along - longer) + p[CA] * (cx * vx + cy * vy)) * per_l
        w[SPIN * m + e] = (cx * vy - cy * vx) * shorter


@kernel
def move_node(m, i, e, at, h, q0, v0, dq, dv, da, moves, q, v):
    """Set q and v of node i to where they are a step e along the direction whose entries begin at `at`, h ahead."""
    for c in range(2):
        k, j = at + (2 * i + c) * LANES, c * m + i
        moves[j] = e * (dq[k] + h * (dv[k] + 0.5 * h * da[k]))
        q[j], v[j] = q0[j] + moves[j], v0[j] + e * (dv[k] + h * da[k])


@kernel
def effects_on(n, t, p1, l0, w, e0, q0, v0, moves, q, v, w1, e, at, h, dq, dv, da, f, hi, hd, power):
    """Set f to the forces of effects a step e along a direction, h ahead of (dq, dv, da), with parameters p1."""
    for i in range(n + 1):
        move_node(n + 1, i, e, at, h, q0, v0, dq, dv, da, moves, q, v)
    stretch_on(n, p1, l0, w, e0, moves, v, w1)
    bend(n, p1, w1)
    effect_forces(n, t, p1, q, v, w1, w, f, hi, hd, power)


@kernel
def changing(directions, way):
    """Whether effects of the model change along some direction."""
    found = False
    for k in range(directions):
        found = found or way[k] >= DIFFERENCED
    return found


@kernel
def recall(state_size, k, e, own, h0, dh, hi):
    """Set hi to the history with which direction k is evaluated: the rope's own, changed, or that of effects that begin."""
    for i in range(state_size):
        hi[i] = dh[state_size * k + i] if own[k] != 0.0 else h0[i] + e * dh[state_size * k + i]


@kernel
def keep_history(state_size, k, e, own, hb, hd, dh):
    """Keep direction k's history hd of a step in which the rope's own became hb."""
    for i in range(state_size):
        dh[state_size * k + i] = hd[i] if own[k] != 0.0 else (hd[i] - hb[i]) / e


@kernel
def effects_along(
    n, t, k, h, state_size, parameters, p, q0, v0, h0, w, e0, at, toward, limit, way, own, dq, dv, da, dh, p1, moves, q, v,
    hi, hd, w1, f, power,
):  # fmt: skip
    """Set f to the forces of effects a step along direction k, hd to their history there; returns that step."""
    b = entry(n + 1, k)
    e = gauge(n, b, p[R], limit[k], dq, dv)
    shift(parameters, k, e, at, toward, p1)
    recall(state_size, k, e, own, h0, dh, hi)
    if way[k] == BEGUN:
        effect_forces(n, t, p1, q0, v0, w, w, f, hi, hd, power)
    else:
        effects_on(n, t, p1, p[ELEMENT], w, e0, q0, v0, moves, q, v, w1, e, b, h, dq, dv, da, f, hi, hd, power)
    return e


@kernel
def histories(
    n, t, state_size, directions, parameters, p, q0, v0, hp, w, e0, at, toward, limit, way, own, dq, dv, da, dh, p1, moves, q, v,
    hi, hb, hd, w1, f, power,
):  # fmt: skip
    """Keep the histories that changed over a step, as the state it reached makes them."""
    for k in range(directions):
        if way[k] == CHANGED:
            e = effects_along(n, t, k, 0.0, state_size, parameters, p, q0, v0, hp, w, e0, at, toward, limit, way, own, dq, dv,
                              da, dh, p1, moves, q, v, hi, hd, w1, f, power)  # fmt: skip
            keep_history(state_size, k, e, own, hb, hd, dh)
