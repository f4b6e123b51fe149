"""Equation (2) and what joins the sheave to the rope: contact and friction at nodes, and the sheave's own forces.

The sheave's unknowns are its axle's depth x_s and its angle theta, positive while the car goes up. Unknown s moves the groove at
a node by a_n along the normal and a_t along the groove; the same two numbers take the node's forces back to the sheave.
"""

import math

from .jit import kernel
from .tower import GRAVITY

FADE = 1e-4  # m, penetration over which contact damping sets in


@kernel
def contact(p, n, W, q, v, by):
    """Add the groove's forces to W.f and, where wanted, their part of the matrices. Returns their sum, downward."""
    N, f = 2 * n, W.f
    turn = q[N + 1] + p.eccentric_phase
    ex, ey = p.eccentricity * math.cos(turn), -p.eccentricity * math.sin(turn)
    x, y = q[N] + ex, p.guide_slope * (q[N] - p.pit) + ey
    total = 0.0
    for i in range(1, n - 1):
        dx, dy = q[2 * i] - x, q[2 * i + 1] - y
        if abs(dx) >= p.radius or dx * dx + dy * dy >= p.radius * p.radius:
            continue
        rr = math.sqrt(dx * dx + dy * dy)
        pen, nx, ny = p.radius - rr, dx / rr, dy / rr
        tx, ty = ny, -nx
        an = (nx + ny * p.guide_slope, nx * ey - ny * ex)
        at = (tx + ty * p.guide_slope, p.radius + tx * ey - ty * ex)
        vn = nx * v[2 * i] + ny * v[2 * i + 1] - an[0] * v[N] - an[1] * v[N + 1]
        slip = tx * v[2 * i] + ty * v[2 * i + 1] - at[0] * v[N] - at[1] * v[N + 1]
        P = p.element * (p.contact_stiffness * pen - p.contact_damping * pen / (pen + FADE) * vn)
        if P <= 0.0:
            continue
        th = math.tanh(slip / p.slip_velocity)
        F = -p.friction * P * th
        fx = P * nx + F * tx
        f[2 * i] += fx
        f[2 * i + 1] += P * ny + F * ty
        total += fx
        f[N] -= P * an[0] + F * at[0]
        f[N + 1] -= P * an[1] + F * at[1]
        if by.tangent:
            Hn, Ht = stiffness(p, pen, vn, P, th, by)
            spread(W, i, (nx, ny), an, at, (Hn, -p.friction * th * Hn, Ht))
    return total


@kernel
def stiffness(p, pen, vn, P, th, by):
    """How the normal force falls with displacement along the normal, and friction along the groove."""
    fade, rise = pen / (pen + FADE), FADE / (pen + FADE) ** 2
    along_normal = p.element * (by.ck * (p.contact_stiffness - p.contact_damping * rise * vn) + by.cc * p.contact_damping * fade)
    return along_normal, by.cc * p.friction * P * (1.0 - th * th) / p.slip_velocity


@kernel
def spread(W, i, normal_way, an, at, H):
    """Add one node's contact to band and border; H: normal force by normal motion, friction by normal motion and by slip."""
    (nx, ny), (Hn, Hx, Ht) = normal_way, H
    tx, ty = ny, -nx
    normal, along = (Hn * nx + Hx * tx, Hn * ny + Hx * ty), (Ht * tx, Ht * ty)
    for a in range(2):
        W.A[2 * i + a, 5 - a] += normal[a] * nx + along[a] * tx
        W.A[2 * i + a, 6 - a] += normal[a] * ny + along[a] * ty
        for s in range(2):
            W.B[s, 2 * i + a + 5] -= normal[a] * an[s] + along[a] * at[s]
    for w in range(2):
        pushed, turned = an[w] * Hn + at[w] * Hx, at[w] * Ht
        W.C[w, 2 * i] -= pushed * nx + turned * tx
        W.C[w, 2 * i + 1] -= pushed * ny + turned * ty
        for s in range(2):
            W.D[w, s] += pushed * an[s] + turned * at[s]


@kernel
def own_forces(p, n, W, q, v, by):
    """Add weight, guides, bearing, unbalance and seal to the sheave's two forces."""
    f, N2 = W.f, 2 * n
    vs, w, turn = v[N2], v[N2 + 1], q[N2 + 1] + p.unbalance_phase
    f[N2] += p.sheave_mass * GRAVITY + p.unbalance * w * w * math.cos(turn)
    f[N2 + 1] -= p.unbalance * GRAVITY * math.sin(turn) + p.seal_stiffness * q[N2 + 1]
    sticky = math.exp(-((vs / p.stribeck_velocity) ** 2))
    guide = (p.guide_coulomb + p.breakaway * sticky) * slope(vs, 5e-4) + p.guide_damping
    bearing = p.bearing_coulomb * slope(w, 0.01) + p.bearing_viscous
    f[N2] -= guide * vs
    f[N2 + 1] -= bearing * w
    if by.tangent:
        W.D[0, 0] += by.cc * guide
        W.D[1, 1] += by.cc * bearing + by.ck * p.seal_stiffness


@kernel
def slope(v, width):
    """tanh(v / width) / v: dry friction over velocity, also its tangent, since the true one lets Newton's iteration overshoot."""
    return math.tanh(v / width) / v if abs(v) > 1e-6 * width else 1.0 / width
