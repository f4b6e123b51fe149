"""Equation (2) and what joins the sheave to the rope: contact and friction at nodes, and the sheave's own forces.

The sheave's unknowns are its axle's depth x_s and its angle theta, positive while the car goes up. Unknown s moves the groove at
a node by a_n along the normal and a_t along the groove; the same two numbers take the node's forces back to the sheave.
"""

import math

from .jit import kernel
from .tower import GRAVITY

FADE = 1e-4  # m, penetration over which contact damping sets in


@kernel
def contact(p, n, q, v, f, ck, cc, tangent, A, B, C, D):
    """Add the groove's forces to f [2 n + 2]; with `tangent` also their part of the matrices. Returns their sum, downward."""
    N = 2 * n
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
        if tangent:
            Hn, Ht = stiffness(p, pen, vn, P, th, ck, cc)
            spread(i, nx, ny, an, at, Hn, -p.friction * th * Hn, Ht, A, B, C, D)
    return total


@kernel
def stiffness(p, pen, vn, P, th, ck, cc):
    """How the normal force falls with displacement along the normal, and friction along the groove."""
    fade, rise = pen / (pen + FADE), FADE / (pen + FADE) ** 2
    along_normal = p.element * (ck * (p.contact_stiffness - p.contact_damping * rise * vn) + cc * p.contact_damping * fade)
    return along_normal, cc * p.friction * P * (1.0 - th * th) / p.slip_velocity


@kernel
def spread(i, nx, ny, an, at, Hn, Hx, Ht, A, B, C, D):
    """Add one node's contact to band and border: Hn normal by normal, Hx friction by normal, Ht friction by slip."""
    tx, ty = ny, -nx
    normal, along = (Hn * nx + Hx * tx, Hn * ny + Hx * ty), (Ht * tx, Ht * ty)
    for a in range(2):
        A[2 * i + a, 5 - a] += normal[a] * nx + along[a] * tx
        A[2 * i + a, 6 - a] += normal[a] * ny + along[a] * ty
        for s in range(2):
            B[s, 2 * i + a + 5] -= normal[a] * an[s] + along[a] * at[s]
    for w in range(2):
        pushed, turned = an[w] * Hn + at[w] * Hx, at[w] * Ht
        C[w, 2 * i] -= pushed * nx + turned * tx
        C[w, 2 * i + 1] -= pushed * ny + turned * ty
        for s in range(2):
            D[w, s] += pushed * an[s] + turned * at[s]


@kernel
def own_forces(p, q, v, N2, f, ck, cc, tangent, D):
    """Add weight, guides, bearing, unbalance and seal to the sheave's two forces."""
    vs, w, turn = v[N2], v[N2 + 1], q[N2 + 1] + p.unbalance_phase
    f[N2] += p.sheave_mass * GRAVITY + p.unbalance * w * w * math.cos(turn)
    f[N2 + 1] -= p.unbalance * GRAVITY * math.sin(turn) + p.seal_stiffness * q[N2 + 1]
    sticky = math.exp(-((vs / p.stribeck_velocity) ** 2))
    guide = (p.guide_coulomb + p.breakaway * sticky) * slope(vs, 5e-4) + p.guide_damping
    bearing = p.bearing_coulomb * slope(w, 0.01) + p.bearing_viscous
    f[N2] -= guide * vs
    f[N2 + 1] -= bearing * w
    if tangent:
        D[0, 0] += cc * guide
        D[1, 1] += cc * bearing + ck * p.seal_stiffness


@kernel
def slope(v, width):
    """tanh(v / width) / v: dry friction over velocity, also its tangent, since the true one lets Newton's iteration overshoot."""
    return math.tanh(v / width) / v if abs(v) > 1e-6 * width else 1.0 / width
