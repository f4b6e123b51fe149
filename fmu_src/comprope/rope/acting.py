"""Directional derivative of the forces where effects act: by differences, whatever the effects are.

An effect that the model is without begins with the direction: its forces alone count, in the present state. Where
the model has effects of its own, all forces are evaluated again in a state a small step away. A rope's elongation
is some 1e-5 of its element's length, itself a difference of positions of tens of metres; so segments are
moved to first order from where they are, and the difference keeps its figures however small it is.
"""

from .elastica import bend, sum_forces
from .hooks import all_forces, all_moments
from .jit import kernel
from .slope import touch_again
from .slots import CA, EA, ELEMENT, RHO, G, J, M
from .vector import LANES
from .work import FX, INVERSE, MOMENT, SPIN, TENSION, TX, TY


@kernel
def begun_effects(n, t, p1, q, v, w, f, hi, hd, power):
    """Set f to the forces of effects alone, with parameters p1; w and (q, v) are of the present state without them.

    Moments M of theirs act as the shear Q = (M_e - M_e+1) / L of each segment. w loses its own moments, and what
    its section FX held to those shears.
    """
    m = n + 1
    for i in range(n):
        w[MOMENT * m + i] = 0.0
    all_moments(n, p1, w, hi, hd, power)
    for e in range(n - 1):
        w[FX * m + e] = (w[MOMENT * m + e] - w[MOMENT * m + e + 1]) * w[INVERSE * m + e]
    f[0], f[m] = -w[FX * m] * w[TY * m], w[FX * m] * w[TX * m]
    for i in range(1, n - 1):
        f[i] = w[FX * m + i - 1] * w[TY * m + i - 1] - w[FX * m + i] * w[TY * m + i]
    for i in range(1, n - 1):
        f[m + i] = w[FX * m + i] * w[TX * m + i] - w[FX * m + i - 1] * w[TX * m + i - 1]
    f[n - 1], f[m + n - 1] = w[FX * m + n - 2] * w[TY * m + n - 2], -w[FX * m + n - 2] * w[TX * m + n - 2]
    f[n], f[m + n] = 0.0, 0.0
    all_forces(n, t, p1, q, v, w, f, power)


@kernel
def add_lane(n, factor, f, at, D):
    """Add `factor` times the forces f to the direction whose entries of D begin at `at`."""
    m = n + 1
    for i in range(m):
        D[at + 2 * LANES * i] += factor * f[i]
        D[at + (2 * i + 1) * LANES] += factor * f[m + i]


@kernel
def set_lane(n, factor, keep, f, f0, a, p, toward, b, dc, at, D):
    """Set that direction to factor (f - f0) + keep (dc - dM a); its parameters' changes begin at b in `toward`."""
    m, dmass = n + 1, toward[b + RHO] * p[ELEMENT] + p[RHO] * toward[b + ELEMENT]
    for i in range(m):
        x, y = at + 2 * LANES * i, at + (2 * i + 1) * LANES
        dx, dy = (toward[b + M], toward[b + J]) if i == n else (dmass, dmass)
        D[x] = factor * (f[i] - f0[i]) + keep * (dc[x] - dx * a[i])
        D[y] = factor * (f[m + i] - f0[m + i]) + keep * (dc[y] - dy * a[m + i])


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
def forces_on(n, t, p1, l0, w, e0, q0, v0, moves, q, v, w1, e, at, h, dq, dv, da, f, touch, hi, hd, power, Z):
    """Set f to what `dynamics.forces` gives a step e along a direction, h ahead of (dq, dv, da), with parameters p1."""
    m = n + 1
    for i in range(m):
        move_node(m, i, e, at, h, q0, v0, dq, dv, da, moves, q, v)
    stretch_on(n, p1, l0, w, e0, moves, v, w1)
    bend(n, p1, w1)
    all_moments(n, p1, w1, hi, hd, power)
    sum_forces(n, p1, v, w1, f)
    f[n], f[m + n] = p1[M] * p1[G], 0.0
    touch_again(n, p1, q, v, f, touch, Z, 0.0, 0.0, False)
    all_forces(n, t, p1, q, v, w1, f, power)
