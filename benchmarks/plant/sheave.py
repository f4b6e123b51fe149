"""Equation (2) and what joins the sheave to the rope: contact and friction at nodes, and the sheave's own forces.

The sheave's unknowns are its axle's depth x_s and its angle theta, positive while the car goes up. Unknown s moves the groove at a
node by a_n along the normal and a_t along the groove; the same two numbers take the node's forces back to the sheave.
"""

import math

from .compiled import kernel
from .tower import GRAVITY

FADE = 1e-4  # m, penetration over which contact damping sets in


@kernel
def contact(p, n, q, v, f, ck, cc, tangent, A, B, C, D):
    """Add the groove's forces to f [2 n + 2]; with `tangent` also their part of the band and the border. Returns the normal sum."""
    N2 = 2 * n
    R = p.radius
    turn = q[N2 + 1] + p.eccentric_phase
    ex, ey = p.eccentricity * math.cos(turn), -p.eccentricity * math.sin(turn)
    axle, aside = q[N2], p.guide_slope * (q[N2] - p.pit)
    reach = R + p.eccentricity
    upward = 0.0
    for i in range(1, n - 1):
        if abs(q[2 * i] - axle) > reach:
            continue
        dx, dy = q[2 * i] - axle - ex, q[2 * i + 1] - aside - ey
        rr = math.sqrt(dx * dx + dy * dy)
        pen = R - rr
        if pen <= 0.0:
            continue
        nx, ny = dx / rr, dy / rr
        tx, ty = ny, -nx
        an = (nx + ny * p.guide_slope, nx * ey - ny * ex)
        at = (tx + ty * p.guide_slope, R + tx * ey - ty * ex)
        vn = nx * v[2 * i] + ny * v[2 * i + 1] - an[0] * v[N2] - an[1] * v[N2 + 1]
        slip = tx * v[2 * i] + ty * v[2 * i + 1] - at[0] * v[N2] - at[1] * v[N2 + 1]
        fade = pen / (pen + FADE)
        P = p.element * (p.contact_stiffness * pen - p.contact_damping * fade * vn)
        if P <= 0.0:
            continue
        th = math.tanh(slip / p.slip_velocity)
        F = -p.friction * P * th
        f[2 * i] += P * nx + F * tx
        f[2 * i + 1] += P * ny + F * ty
        upward += P * nx + F * tx
        for s in range(2):
            f[N2 + s] -= P * an[s] + F * at[s]
        if tangent:
            rise = FADE / (pen + FADE) ** 2
            Hn = p.element * (ck * (p.contact_stiffness - p.contact_damping * rise * vn) + cc * p.contact_damping * fade)
            Hx = -p.friction * th * Hn
            Ht = cc * p.friction * P * (1.0 - th * th) / p.slip_velocity
            gx = (Hn * nx + Hx * tx, Hn * ny + Hx * ty)  # force on the node by a unit displacement along the normal, reversed
            gt = (Ht * tx, Ht * ty)
            for a in range(2):
                A[2 * i + a, 5 - a] += gx[a] * nx + gt[a] * tx
                A[2 * i + a, 6 - a] += gx[a] * ny + gt[a] * ty
                for s in range(2):
                    B[s, 2 * i + a + 5] -= gx[a] * an[s] + gt[a] * at[s]
            for w in range(2):
                normal, along = an[w] * Hn + at[w] * Hx, at[w] * Ht
                C[w, 2 * i] -= normal * nx + along * tx
                C[w, 2 * i + 1] -= normal * ny + along * ty
                for s in range(2):
                    D[w, s] += normal * an[s] + along * at[s]
    return upward


@kernel
def own_forces(p, q, v, N2, f, ck, cc, tangent, D):
    """Add weight, guides, bearing, unbalance and seal to the sheave's two forces."""
    vs, w, turn = v[N2], v[N2 + 1], q[N2 + 1] + p.unbalance_phase
    f[N2] += p.sheave_mass * GRAVITY + p.unbalance * w * w * math.cos(turn)
    f[N2 + 1] -= p.unbalance * GRAVITY * math.sin(turn) + p.seal_stiffness * q[N2 + 1]
    sticky = math.exp(-((vs / p.stribeck_velocity) ** 2))
    dry = p.guide_coulomb + p.breakaway * sticky
    th = math.tanh(vs / 5e-4)
    f[N2] -= dry * th + p.guide_damping * vs
    tw = math.tanh(w / 0.01)
    f[N2 + 1] -= p.bearing_coulomb * tw + p.bearing_viscous * w
    if tangent:
        falling = p.breakaway * sticky * 2.0 * vs / p.stribeck_velocity**2
        D[0, 0] += cc * (dry * (1.0 - th * th) / 5e-4 + p.guide_damping - min(falling * th, 0.0))
        D[1, 1] += cc * (p.bearing_coulomb * (1.0 - tw * tw) / 0.01 + p.bearing_viscous) + ck * p.seal_stiffness
