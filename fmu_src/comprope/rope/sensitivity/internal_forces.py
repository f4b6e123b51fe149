"""Directional derivative of the forces: how the right-hand sides of eq. (1) and (2) answer a small move.

    D = lim [f(q + e dq, v + e dv, p + e dp) - f(q, v, p)] / e

Tension, bending, damping and weight are differentiated by hand, for LANES directions at a time and in one sweep
along the rope; `sheave_contact` does the same for the contact. How a block of directions is stored: see `directions`.
"""

from typing import NamedTuple

from ...kernels.jit import kernel
from ..mechanics.axial_law import force_by_ratio
from ..parameters.parameter_vector import CA, CB, CE, EA, EI, ELEMENT, RATIO, RHO, G, J, M
from ..runtime.array_layout import BEND_RATE, CURVATURE, INVERSE, SHARE, SHEAR, SPIN, TENSION, TX, TY
from ..runtime.simd import LANES, load, store


class Combination(NamedTuple):
    """D becomes `new` times the derivative, predicted h ahead, plus `keep` times what the last step has left."""

    h: float
    new: float
    keep: float


@kernel
def elongations(n, p, v, w, e0):
    """Set e0 to L - l of each segment, recovered from its tension T = (EA (L - l) + c_A rate) / l, and then to its rate.

    Where the rope is pushed, and its force is another, L - l is that of the segment's length.
    """
    m, l, per_ea = n + 1, p[ELEMENT], 1.0 / p[EA]
    for e in range(n - 1):
        e0[m + e] = w[TX * m + e] * (v[e + 1] - v[e]) + w[TY * m + e] * (v[m + e + 1] - v[m + e])
    for e in range(n - 1):
        e0[e] = (w[TENSION * m + e] * l - p[CA] * e0[m + e]) * per_ea
    if w[SHARE * m + n] > 0.0:
        for e in range(n - 1):
            if w[SHARE * m + e] != 1.0:
                e0[e] = 1.0 / w[INVERSE * m + e] - l


@kernel
def predicted(entry, h, half, dq, dv, da):
    """Change of position and velocity at an entry, predicted h ahead; half is h^2 / 2."""
    v, a = load(dv, entry), load(da, entry)
    return load(dq, entry) + h * v + half * a, v + h * a


@kernel
def segment_derivative(p, m, w, e0, e, stiffness, a, b):
    """Changes of a segment's direction [rad], length, tension and spin, from those between its nodes.

    With t and n of the segment, and (a, b) the changes of position and velocity between its nodes,

        dphi = n . a / L,  dL = t . a,
        dT = (EA (dL - dl) + dEA (L - l) + c_A (t . b + n . a spin) + dc_A rate - T dl) / l,
        dspin = (n . b - dphi rate - spin dL) / L.

    `stiffness` has EA, c_A, dEA and dc_A, all per l, -dl / l, EA times that, and the change of the compression ratio.
    Where the rope is pushed, T is a function of that of a rod (see `axial_law`).
    """
    ea, ca, dea, dca, shorter, unloaded, dratio = stiffness
    ax, ay = a
    bx, by = b
    tx, ty, inverse, spin, rate = w[TX * m + e], w[TY * m + e], w[INVERSE * m + e], w[SPIN * m + e], e0[m + e]
    along, across = tx * ax + ty * ay, tx * ay - ty * ax
    tilt = inverse * across
    tension = ea * along + ca * (tx * bx + ty * by + spin * across) + unloaded
    share = w[SHARE * m + e]
    if share == 1.0:
        tension = tension + e0[e] * dea + rate * dca + w[TENSION * m + e] * shorter
    else:
        rod = ea * e0[e] + ca * rate
        tension = share * (tension + e0[e] * dea + rate * dca + rod * shorter)
        tension = tension + ((w[TENSION * m + e] - share * rod) / ea) * dea + force_by_ratio(p, rod) * dratio
    return tilt, along, tension, inverse * (tx * by - ty * bx - rate * tilt - spin * along)


@kernel
def moment_derivative(m, w, i, stiffness, bent, faster):
    """Change of a node's moment, dM = EI dkappa + dEI kappa + c_B dkappa' + dc_B kappa', a prime being the rate.

    `bent` and `faster` are the changes of the angle between its segments and of that angle's rate. `stiffness` has EI and
    c_B per l, and dEI and dc_B, which include how curvature answers l.
    """
    ei, cb, dei, dcb = stiffness
    return ei * bent + cb * faster + w[CURVATURE * m + i] * dei + w[BEND_RATE * m + i] * dcb


@kernel
def force_derivative(m, w, e, tilt, longer, tension, moments):
    """Change of a segment's force F = T t + Q n: dF = (dT - Q dphi) t + (dQ + T dphi) n.

    `moments` is the change of the moments' difference over the segment, of which Q is the share per length.
    """
    tx, ty, shear = w[TX * m + e], w[TY * m + e], w[SHEAR * m + e]
    along = tension - shear * tilt
    across = w[INVERSE * m + e] * (moments - shear * longer) + w[TENSION * m + e] * tilt
    return tx * along - ty * across, ty * along + tx * across


@kernel
def weight_derivative(p, dp, d):
    """Changes of a node's weight and of its external damping, by the parameters."""
    rho, l = load(dp, d + RHO * LANES), load(dp, d + ELEMENT * LANES)
    weight = (p[ELEMENT] * p[G]) * rho + (p[RHO] * p[G]) * l + (p[RHO] * p[ELEMENT]) * load(dp, d + G * LANES)
    return weight, p[ELEMENT] * load(dp, d + CE * LANES) + p[CE] * l


@kernel
def mass_derivative(p, dp, d):
    """Change of the mass of a node."""
    return p[ELEMENT] * load(dp, d + RHO * LANES) + p[RHO] * load(dp, d + ELEMENT * LANES)


@kernel
def set_row(new, keep, force, a, dmass, dc, D, entry):
    """Set an entry of D to new dforce + keep dc - dmass a."""
    store(D, entry, new * force + keep * load(dc, entry) - a * dmass)


@kernel
def rope_derivative(n, p, state, w, directions, block, combination):
    """Set a block of D to new D + keep (dc - dM a), D the changes of tension, bending, damping and weight.

    w belongs to the present state. The sweep goes from node to node; each turn ends with the forces on the
    node before the last.
    """
    h, new, keep = combination
    v, a, e0, D = state.v, state.a, directions.work.elongations, directions.work.D
    dp, dq, dv, da, dc = directions.dp, directions.dq, directions.dv, directions.da, directions.dc
    d, base = directions.parameters * LANES * block, 2 * (n + 1) * LANES * block
    m, half, drag, per_l = n + 1, 0.5 * h * h, p[CE] * p[ELEMENT], 1.0 / p[ELEMENT]
    ea, ca, ei, cb = p[EA] * per_l, p[CA] * per_l, p[EI] * per_l, p[CB] * per_l
    weight, ddrag = weight_derivative(p, dp, d)
    dmass, longer = keep * mass_derivative(p, dp, d), load(dp, d + ELEMENT * LANES)
    dea, dca = per_l * load(dp, d + EA * LANES), per_l * load(dp, d + CA * LANES)
    axial = (ea, ca, dea, dca, -per_l * longer, -ea * longer, load(dp, d + RATIO * LANES))
    dei, dcb = load(dp, d + EI * LANES) - ei * longer, load(dp, d + CB * LANES) - cb * longer
    bending = (ei, cb, dei, dcb)
    x, vx = predicted(base, h, half, dq, dv, da)
    y, vy = predicted(base + LANES, h, half, dq, dv, da)
    x1, vx1 = predicted(base + 2 * LANES, h, half, dq, dv, da)
    y1, vy1 = predicted(base + 3 * LANES, h, half, dq, dv, da)
    tilt, longer, tension, spin = segment_derivative(p, m, w, e0, 0, axial, (x1 - x, y1 - y), (vx1 - vx, vy1 - vy))
    moment, fx, fy = 0.0 * x, 0.0 * x, 0.0 * x
    for e in range(1, n - 1):
        at = base + 2 * LANES * e
        x, y, vx0, vy0, vx, vy = x1, y1, vx, vy, vx1, vy1
        x1, vx1 = predicted(at + 2 * LANES, h, half, dq, dv, da)
        y1, vy1 = predicted(at + 3 * LANES, h, half, dq, dv, da)
        tilt1, longer1, tension1, spin1 = segment_derivative(p, m, w, e0, e, axial, (x1 - x, y1 - y), (vx1 - vx, vy1 - vy))
        moment1 = moment_derivative(m, w, e, bending, tilt1 - tilt, spin1 - spin)
        fx1, fy1 = force_derivative(m, w, e - 1, tilt, longer, tension, moment - moment1)
        set_row(new, keep, fx1 - fx + weight - v[e - 1] * ddrag - drag * vx0, a[e - 1], dmass, dc, D, at - 2 * LANES)
        set_row(new, keep, fy1 - fy - v[m + e - 1] * ddrag - drag * vy0, a[m + e - 1], dmass, dc, D, at - LANES)
        if e == 1:
            store(D, base, new * (fx1 + 0.5 * weight))
            store(D, base + LANES, new * fy1)
        tilt, longer, tension, spin, moment, fx, fy = tilt1, longer1, tension1, spin1, moment1, fx1, fy1
    fx1, fy1 = force_derivative(m, w, n - 2, tilt, longer, tension, moment)
    at, last = base + 2 * LANES * (n - 2), n - 2
    set_row(new, keep, fx1 - fx + weight - v[last] * ddrag - drag * vx, a[last], dmass, dc, D, at)
    set_row(new, keep, fy1 - fy - v[m + last] * ddrag - drag * vy, a[m + last], dmass, dc, D, at + LANES)
    store(D, at + 2 * LANES, new * (0.5 * weight - fx1))
    store(D, at + 3 * LANES, -new * fy1)
    sheave = p[G] * load(dp, d + M * LANES) + p[M] * load(dp, d + G * LANES)
    set_row(new, keep, sheave, keep * a[n], load(dp, d + M * LANES), dc, D, at + 4 * LANES)
    set_row(new, keep, 0.0 * sheave, keep * a[m + n], load(dp, d + J * LANES), dc, D, at + 5 * LANES)
