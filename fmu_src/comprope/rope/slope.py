"""Directional derivative of the forces: how the right-hand sides of eq. (1) and (2) answer a small move.

    D = lim [f(q + e dq, v + e dv, p + e dp, history + e dhistory) - f(q, v, p, history)] / e

Tension, bending, damping and weight are differentiated by hand (`rope_slope`); contact by differences among
the few nodes near the groove (`contact_slope`). Where an effect adds forces or moments of its own, all is differenced
(`forces_on`): then segments are moved to first order from where they are, since their elongation, some 1e-5 of
their length, is itself a difference of positions of tens of metres.
"""

from .contact import near, touch_piece
from .elastica import bend, sum_forces
from .hooks import all_forces, all_groove, all_moments
from .jit import contracted, kernel
from .slots import CA, CB, CE, EA, EI, ELEMENT, RHO, G, M
from .work import (
    BEND_RATE, CURVATURE, ELASTIC, FIRST, FORCE_X, FRICTION_LOSS, FX, FY, INVERSE, LAST, MOMENT, NORMAL_LOSS, SHEAR, SPIN, TENSION,
    TX, TY,
)  # fmt: skip

# Where changes stand in a workspace of their own: of a segment's direction [rad] and of its length [m].
TILT, LONGER = TX, TY


@kernel
def elongations(n, p, v, w, e0):
    """Set e0 to L - l of each segment, recovered from its tension T = (EA (L - l) + c_A rate) / l, and then to its rate."""
    m, l, per_ea = n + 1, p[ELEMENT], 1.0 / p[EA]
    for e in range(n - 1):
        e0[m + e] = w[TX * m + e] * (v[e + 1] - v[e]) + w[TY * m + e] * (v[m + e + 1] - v[m + e])
    for e in range(n - 1):
        e0[e] = (w[TENSION * m + e] * l - p[CA] * e0[m + e]) * per_ea


@contracted
def stretch_slope(n, p, w, e0, dp, d, b, dq, dv, W):
    """Changes of each segment's direction, length, tension and spin, from t and n of the segment:

    dphi = n . dq' / L,  dL = t . dq',  rate = t . v',
    dT = (EA (dL - dl) + dEA (L - l) + c_A (t . dv' + n . dq' spin) + dc_A rate - T dl) / l,
    dspin = (n . dv' - dphi rate - spin dL) / L,

    a prime being the difference of the segment's nodes. Directions begin at d in dp and at b in dq and dv.
    """
    m, per_l = n + 1, 1.0 / p[ELEMENT]
    ea, ca, dea, dca, shorter = p[EA] * per_l, p[CA] * per_l, dp[d + EA] * per_l, dp[d + CA] * per_l, -dp[d + ELEMENT] * per_l
    unloaded = p[EA] * shorter
    for e in range(n - 1):
        tx, ty, inverse, spin = w[TX * m + e], w[TY * m + e], w[INVERSE * m + e], w[SPIN * m + e]
        ax, ay = dq[b + e + 1] - dq[b + e], dq[b + m + e + 1] - dq[b + m + e]
        bx, by = dv[b + e + 1] - dv[b + e], dv[b + m + e + 1] - dv[b + m + e]
        along, across = tx * ax + ty * ay, tx * ay - ty * ax
        tilt = across * inverse
        W[TILT * m + e] = tilt
        W[LONGER * m + e] = along
        faster = tx * bx + ty * by + across * spin
        W[TENSION * m + e] = ea * along + ca * faster + dea * e0[e] + dca * e0[m + e] + shorter * w[TENSION * m + e] + unloaded
        W[SPIN * m + e] = (tx * by - ty * bx - tilt * e0[m + e] - spin * along) * inverse


@contracted
def bend_slope(n, p, w, dp, d, W):
    """Change of each moment: dM = EI dkappa + dEI kappa + c_B dkappa' + dc_B kappa', a prime being the rate."""
    m, per_l = n + 1, 1.0 / p[ELEMENT]
    ei, cb, shorter = p[EI] * per_l, p[CB] * per_l, -dp[d + ELEMENT] * per_l
    dei, dcb = dp[d + EI] + p[EI] * shorter, dp[d + CB] + p[CB] * shorter
    for i in range(1, n - 1):
        kappa, turning = w[CURVATURE * m + i], w[BEND_RATE * m + i]
        bent, faster = W[TILT * m + i] - W[TILT * m + i - 1], W[SPIN * m + i] - W[SPIN * m + i - 1]
        W[MOMENT * m + i] = ei * bent + cb * faster + dei * kappa + dcb * turning


@contracted
def sum_slope(n, p, v, w, dp, d, b, dv, W, D):
    """Set row b of D to the change of tension, bending, damping and weight on each node.

    With F = T t + Q n of a segment, dF = (dT - Q dphi) t + (dQ + T dphi) n.
    """
    m, l = n + 1, p[ELEMENT]
    for e in range(n - 1):
        tx, ty, inverse = w[TX * m + e], w[TY * m + e], w[INVERSE * m + e]
        tilt, shear = W[TILT * m + e], w[SHEAR * m + e]
        dshear = (W[MOMENT * m + e] - W[MOMENT * m + e + 1] - shear * W[LONGER * m + e]) * inverse
        along, across = W[TENSION * m + e] - shear * tilt, dshear + w[TENSION * m + e] * tilt
        W[FX * m + e] = along * tx - across * ty
        W[FY * m + e] = along * ty + across * tx
    weight = dp[d + RHO] * l * p[G] + p[RHO] * dp[d + ELEMENT] * p[G] + p[RHO] * l * dp[d + G]
    drag, ddrag = p[CE] * l, dp[d + CE] * l + p[CE] * dp[d + ELEMENT]
    for i in range(1, n - 1):
        D[b + i] = W[FX * m + i] - W[FX * m + i - 1] + weight - ddrag * v[i] - drag * dv[b + i]
    for i in range(1, n - 1):
        D[b + m + i] = W[FY * m + i] - W[FY * m + i - 1] - ddrag * v[m + i] - drag * dv[b + m + i]
    D[b], D[b + m] = W[FX * m] + 0.5 * weight, W[FY * m]
    D[b + n - 1], D[b + m + n - 1] = -W[FX * m + n - 2] + 0.5 * weight, -W[FY * m + n - 2]
    D[b + n], D[b + m + n] = dp[d + M] * p[G] + p[M] * dp[d + G], 0.0


@kernel
def rope_slope(n, p, v, w, e0, dp, d, b, dq, dv, W, D):
    """Set row b of D to how tension, bending, damping and weight answer; w and e0 belong to the present state."""
    stretch_slope(n, p, w, e0, dp, d, b, dq, dv, W)
    bend_slope(n, p, w, dp, d, W)
    sum_slope(n, p, v, w, dp, d, b, dv, W, D)


@kernel
def touch_again(n, p, q, v, f, touch, Z):
    """Add the contact forces as `contact.add_contact` has them, among the nodes that it found near the groove."""
    ex, ey, gx, gy = all_groove(p, q[n + n + 1])
    touch[FORCE_X], touch[ELASTIC], touch[NORMAL_LOSS], touch[FRICTION_LOSS] = 0.0, 0.0, 0.0, 0.0
    for i in range(int(touch[FIRST]), int(touch[LAST]) + 1):
        if near(n + 1, p, q, i, q[n] + ex, ey):
            touch_piece(n, p, q, v, f, touch, i, ex, ey, gx, gy, Z, 0.0, 0.0, False)


@kernel
def contact_alone(n, p, q, v, f, touch, Z):
    """Set f to the contact forces, on the nodes near the groove and on the sheave only."""
    m = n + 1
    for i in range(int(touch[FIRST]) - 1, int(touch[LAST]) + 2):
        f[i], f[m + i] = 0.0, 0.0
    f[n], f[m + n] = 0.0, 0.0
    touch_again(n, p, q, v, f, touch, Z)


@kernel
def contact_slope(n, p1, e, b, q0, v0, dq, dv, q, v, f, f0, touch, Z, D):
    """Add to row b of D how the contact answers, where its forces f0 are known: by a difference e."""
    m, first, last = n + 1, int(touch[FIRST]) - 1, int(touch[LAST]) + 1
    for c in (0, m):
        for i in range(first, last + 1):
            q[c + i], v[c + i] = q0[c + i] + e * dq[b + c + i], v0[c + i] + e * dv[b + c + i]
        q[c + n], v[c + n] = q0[c + n] + e * dq[b + c + n], v0[c + n] + e * dv[b + c + n]
    contact_alone(n, p1, q, v, f, touch, Z)
    per_e = 1.0 / e
    for c in (0, m):
        for i in range(first, last + 1):
            D[b + c + i] += (f[c + i] - f0[c + i]) * per_e
        D[b + c + n] += (f[c + n] - f0[c + n]) * per_e


@kernel
def stretch_on(n, p, l0, w0, e0, moves, v, w):
    """What `elastica.stretch` gives at q + moves, to first order in these; w0 and e0 belong to q and to elements of length l0."""
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
def forces_on(n, t, p, l0, w0, e0, moves, q, v, w, f, touch, h0, h1, power, Z):
    """What `dynamics.forces` gives at q, which is the place of w0 and e0 changed by small moves."""
    m = n + 1
    stretch_on(n, p, l0, w0, e0, moves, v, w)
    bend(n, p, w)
    all_moments(n, p, w, h0, h1, power)
    sum_forces(n, p, v, w, f)
    f[n] = p[M] * p[G]
    f[m + n] = 0.0
    touch_again(n, p, q, v, f, touch, Z)
    all_forces(n, t, p, q, v, w, f, power)
