"""Directional derivative of the forces: how the right-hand sides of eq. (1) and (2) answer a small move.

    D = lim [f(q + e dq, v + e dv, p + e dp) - f(q, v, p)] / e

Tension, bending, damping and weight are differentiated by hand, for LANES directions at a time and in one sweep
along the rope; `groove` does the same for the contact. The parameters' changes dp have a lane for each direction
as well: quantity j of a block at (parameters block + j) LANES.
"""

from ..mechanics.effect_hooks import all_groove
from ..mechanics.sheave_contact import near, touch_piece
from ..runtime.array_layout import (
    BEND_RATE,
    CURVATURE,
    ELASTIC,
    FIRST,
    FORCE_X,
    FRICTION_LOSS,
    INVERSE,
    LAST,
    NORMAL_LOSS,
    SHEAR,
    SPIN,
    TENSION,
    TX,
    TY,
)
from ..runtime.jit import kernel
from ..runtime.parameter_vector import CA, CB, CE, EA, EI, ELEMENT, RHO, G, J, M
from ..runtime.simd import LANES, put, take


@kernel
def elongations(n, p, v, w, e0):
    """Set e0 to L - l of each segment, recovered from its tension T = (EA (L - l) + c_A rate) / l, and then to its rate."""
    m, l, per_ea = n + 1, p[ELEMENT], 1.0 / p[EA]
    for e in range(n - 1):
        e0[m + e] = w[TX * m + e] * (v[e + 1] - v[e]) + w[TY * m + e] * (v[m + e + 1] - v[m + e])
    for e in range(n - 1):
        e0[e] = (w[TENSION * m + e] * l - p[CA] * e0[m + e]) * per_ea


@kernel
def ahead(at, h, half, dq, dv, da):
    """Predicted change of position and velocity where the three arrays have their entry `at`."""
    v, a = take(dv, at), take(da, at)
    return take(dq, at) + h * v + half * a, v + h * a


@kernel
def segment_slope(m, w, e0, e, ea, ca, dea, dca, shorter, unloaded, ax, ay, bx, by):
    """Changes of a segment's direction [rad], length, tension and spin, from those between its nodes.

    With t and n of the segment, and (a, b) the changes of position and velocity between its nodes,

        dphi = n . a / L,  dL = t . a,
        dT = (EA (dL - dl) + dEA (L - l) + c_A (t . b + n . a spin) + dc_A rate - T dl) / l,
        dspin = (n . b - dphi rate - spin dL) / L.

    ea, ca, dea, dca are per l; `shorter` is -dl / l and `unloaded` is EA times that.
    """
    tx, ty, inverse, spin, rate = w[TX * m + e], w[TY * m + e], w[INVERSE * m + e], w[SPIN * m + e], e0[m + e]
    along, across = tx * ax + ty * ay, tx * ay - ty * ax
    tilt = inverse * across
    tension = ea * along + ca * (tx * bx + ty * by + spin * across) + unloaded
    tension = tension + e0[e] * dea + rate * dca + w[TENSION * m + e] * shorter
    return tilt, along, tension, inverse * (tx * by - ty * bx - rate * tilt - spin * along)


@kernel
def moment_slope(m, w, i, ei, cb, dei, dcb, bent, faster):
    """Change of a node's moment, dM = EI dkappa + dEI kappa + c_B dkappa' + dc_B kappa', a prime being the rate.

    `bent` and `faster` are the changes of the angle between its segments and of that angle's rate; ei and cb are per l, and
    dei and dcb have taken in how curvature answers l.
    """
    return ei * bent + cb * faster + w[CURVATURE * m + i] * dei + w[BEND_RATE * m + i] * dcb


@kernel
def force_slope(m, w, e, tilt, longer, tension, moments):
    """Change of a segment's force F = T t + Q n: dF = (dT - Q dphi) t + (dQ + T dphi) n.

    `moments` is the change of the moments' difference over the segment, of which Q is the share per length.
    """
    tx, ty, shear = w[TX * m + e], w[TY * m + e], w[SHEAR * m + e]
    along = tension - shear * tilt
    across = w[INVERSE * m + e] * (moments - shear * longer) + w[TENSION * m + e] * tilt
    return tx * along - ty * across, ty * along + tx * across


@kernel
def weight_slope(p, dp, d):
    """Changes of a node's weight and of its external damping, by the parameters."""
    rho, l = take(dp, d + RHO * LANES), take(dp, d + ELEMENT * LANES)
    weight = (p[ELEMENT] * p[G]) * rho + (p[RHO] * p[G]) * l + (p[RHO] * p[ELEMENT]) * take(dp, d + G * LANES)
    return weight, p[ELEMENT] * take(dp, d + CE * LANES) + p[CE] * l


@kernel
def mass_slope(p, dp, d):
    """Change of the mass of a node."""
    return p[ELEMENT] * take(dp, d + RHO * LANES) + p[RHO] * take(dp, d + ELEMENT * LANES)


@kernel
def row(new, keep, force, a, dmass, dc, D, at):
    """Set entry `at` of D to new dforce + keep dc - dmass a."""
    put(D, at, new * force + keep * take(dc, at) - a * dmass)


@kernel
def rope_slope(n, p, v, a, w, e0, dp, d, base, h, new, keep, dq, dv, da, dc, D):
    """Set a block of D to new D + keep (dc - dM a): the changes of tension, bending, damping and weight, h ahead of (dq, dv, da).

    w and e0 belong to the present state. The sweep goes from node to node; each turn ends with the forces on the
    node before the last.
    """
    m, half, drag, per_l = n + 1, 0.5 * h * h, p[CE] * p[ELEMENT], 1.0 / p[ELEMENT]
    ea, ca, ei, cb = p[EA] * per_l, p[CA] * per_l, p[EI] * per_l, p[CB] * per_l
    weight, ddrag = weight_slope(p, dp, d)
    dmass, longer = keep * mass_slope(p, dp, d), take(dp, d + ELEMENT * LANES)
    dea, dca = per_l * take(dp, d + EA * LANES), per_l * take(dp, d + CA * LANES)
    shorter, unloaded = -per_l * longer, -ea * longer
    dei, dcb = take(dp, d + EI * LANES) - ei * longer, take(dp, d + CB * LANES) - cb * longer
    x, vx = ahead(base, h, half, dq, dv, da)
    y, vy = ahead(base + LANES, h, half, dq, dv, da)
    x1, vx1 = ahead(base + 2 * LANES, h, half, dq, dv, da)
    y1, vy1 = ahead(base + 3 * LANES, h, half, dq, dv, da)
    ax, ay, bx, by = x1 - x, y1 - y, vx1 - vx, vy1 - vy
    tilt, longer, tension, spin = segment_slope(m, w, e0, 0, ea, ca, dea, dca, shorter, unloaded, ax, ay, bx, by)
    moment, fx, fy = 0.0 * x, 0.0 * x, 0.0 * x
    for e in range(1, n - 1):
        at = base + 2 * LANES * e
        x, y, vx0, vy0, vx, vy = x1, y1, vx, vy, vx1, vy1
        x1, vx1 = ahead(at + 2 * LANES, h, half, dq, dv, da)
        y1, vy1 = ahead(at + 3 * LANES, h, half, dq, dv, da)
        ax, ay, bx, by = x1 - x, y1 - y, vx1 - vx, vy1 - vy
        tilt1, longer1, tension1, spin1 = segment_slope(m, w, e0, e, ea, ca, dea, dca, shorter, unloaded, ax, ay, bx, by)
        moment1 = moment_slope(m, w, e, ei, cb, dei, dcb, tilt1 - tilt, spin1 - spin)
        fx1, fy1 = force_slope(m, w, e - 1, tilt, longer, tension, moment - moment1)
        row(new, keep, fx1 - fx + weight - v[e - 1] * ddrag - drag * vx0, a[e - 1], dmass, dc, D, at - 2 * LANES)
        row(new, keep, fy1 - fy - v[m + e - 1] * ddrag - drag * vy0, a[m + e - 1], dmass, dc, D, at - LANES)
        if e == 1:
            put(D, base, new * (fx1 + 0.5 * weight))
            put(D, base + LANES, new * fy1)
        tilt, longer, tension, spin, moment, fx, fy = tilt1, longer1, tension1, spin1, moment1, fx1, fy1
    fx1, fy1 = force_slope(m, w, n - 2, tilt, longer, tension, moment)
    at, last = base + 2 * LANES * (n - 2), n - 2
    row(new, keep, fx1 - fx + weight - v[last] * ddrag - drag * vx, a[last], dmass, dc, D, at)
    row(new, keep, fy1 - fy - v[m + last] * ddrag - drag * vy, a[m + last], dmass, dc, D, at + LANES)
    put(D, at + 2 * LANES, new * (0.5 * weight - fx1))
    put(D, at + 3 * LANES, -new * fy1)
    sheave = p[G] * take(dp, d + M * LANES) + p[M] * take(dp, d + G * LANES)
    row(new, keep, sheave, keep * a[n], take(dp, d + M * LANES), dc, D, at + 4 * LANES)
    row(new, keep, 0.0 * sheave, keep * a[m + n], take(dp, d + J * LANES), dc, D, at + 5 * LANES)


@kernel
def touch_again(n, p, q, v, f, touch, Z, ck, cc, tangent):
    """Add contact forces, and with `tangent` their tangent to Z, among the nodes near the groove that `touch` names."""
    ex, ey, gx, gy = all_groove(p, q[n + n + 1])
    touch[FORCE_X], touch[ELASTIC], touch[NORMAL_LOSS], touch[FRICTION_LOSS] = 0.0, 0.0, 0.0, 0.0
    for i in range(int(touch[FIRST]), int(touch[LAST]) + 1):
        if near(n + 1, p, q, i, q[n] + ex, ey):
            touch_piece(n, p, q, v, f, touch, i, ex, ey, gx, gy, Z, ck, cc, tangent)


@kernel
def contact_alone(n, p, q, v, f, touch, Z, ck, cc, tangent):
    """Set f to the contact forces, on the nodes near the groove and on the sheave only; for the rest see `touch_again`."""
    m = n + 1
    for i in range(int(touch[FIRST]) - 1, int(touch[LAST]) + 2):
        f[i], f[m + i] = 0.0, 0.0
    f[n], f[m + n] = 0.0, 0.0
    touch_again(n, p, q, v, f, touch, Z, ck, cc, tangent)
