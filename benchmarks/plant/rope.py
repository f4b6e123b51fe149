"""Equation (1) inside the rope: axial force along segments, bending moments at nodes, and their tangent.

Segment e runs from node e to e+1: direction (c, s), normal (-s, c), length L. Node i turns by alpha between segments i-1 and i;
its curvature is that of the circle touching both in their middles, kappa = 2 tan(alpha / 2) / l.
"""

import math

from .jit import kernel


@kernel
def segments(p, n, thermal, q, v, S):
    """Rows of S [n, 6]: cosine, sine, length, axial force, turning rate, 1 / length."""
    for e in range(n - 1):
        dx = q[2 * e + 2] - q[2 * e]
        dy = q[2 * e + 3] - q[2 * e + 1]
        vx = v[2 * e + 2] - v[2 * e]
        vy = v[2 * e + 3] - v[2 * e + 1]
        L = (dx * dx + dy * dy) ** 0.5
        b = 1.0 / L
        c, s = dx * b, dy * b
        S[e, 0], S[e, 1], S[e, 2], S[e, 5] = c, s, L, b
        S[e, 3] = (p.EA * (L - p.element * (1.0 + thermal)) + p.axial_damping * (c * vx + s * vy)) / p.element
        S[e, 4] = (c * vy - s * vx) * b


@kernel
def moments(p, n, S, kappa0, z0, m, kappa):
    """Curvature of each inner node and its moment, as a force on the angle between segments."""
    l = p.element
    m[0] = m[n - 1] = 0.0
    for i in range(1, n - 1):
        c0, s0, c1, s1 = S[i - 1, 0], S[i - 1, 1], S[i, 0], S[i, 1]
        t = (c0 * s1 - s0 * c1) / (1.0 + c0 * c1 + s0 * s1)
        k = 2.0 * t / l
        kappa[i] = k
        widen = 1.0 + t * t
        m[i] = (p.EI * (k - p.set_curvature) + p.bending_damping * (S[i, 4] - S[i - 1, 4]) * widen / l) * widen
    if p.dahl_moment > 0.0:
        for i in range(1, n - 1):
            m[i] += p.dahl_moment * dahl_state(p, kappa[i] - kappa0[i], z0[i])


@kernel
def dahl_state(p, change, z):
    """Dahl's state after a change of curvature: dz = (dk - |dk| z) / yield curvature, solved exactly for one direction."""
    end = 1.0 if change > 0.0 else -1.0
    return end + (z - end) * math.exp(-abs(change) / p.dahl_curvature)


@kernel
def inner_forces(n, S, m, f):
    """f = internal forces on all nodes; each segment carries its axial force and the shear (m_e - m_e+1) / L."""
    bx = by = 0.0
    for e in range(n - 1):
        c, s, N = S[e, 0], S[e, 1], S[e, 3]
        Q = (m[e] - m[e + 1]) * S[e, 5]
        fx, fy = N * c - Q * s, N * s + Q * c
        f[2 * e], f[2 * e + 1] = fx - bx, fy - by
        bx, by = fx, fy
    f[2 * n - 2], f[2 * n - 1] = -bx, -by


@kernel
def inner_tangent(p, n, W, rope, by):
    """Add ck K + cc C of the inner forces to the band W.A, diagonal in column 5. How damping turns is left out."""
    S, m, A, ck, cc, l = W.S, W.m, W.A, by.ck, by.cc, p.element
    ea = (ck * p.EA + cc * p.axial_damping) / l
    for e in range(n - 1):
        c, s, N, b = S[e, 0], S[e, 1], S[e, 3], S[e, 5]
        Q = ck * (m[e] - m[e + 1]) * b * b
        g = ck * N * b
        xx = ea * c * c + g * s * s + 2.0 * Q * s * c
        xy = (ea - g) * c * s - Q * (c * c - s * s)
        yy = ea * s * s + g * c * c - 2.0 * Q * s * c
        r = 2 * e
        A[r, 5] += xx
        A[r, 6] += xy
        A[r + 1, 4] += xy
        A[r + 1, 5] += yy
        A[r, 7] -= xx
        A[r, 8] -= xy
        A[r + 1, 6] -= xy
        A[r + 1, 7] -= yy
        A[r + 2, 3] -= xx
        A[r + 2, 4] -= xy
        A[r + 3, 2] -= xy
        A[r + 3, 3] -= yy
        A[r + 2, 5] += xx
        A[r + 2, 6] += xy
        A[r + 3, 4] += xy
        A[r + 3, 5] += yy
    for i in range(1, n - 1):
        k = (ck * p.EI + cc * p.bending_damping) / l
        if p.dahl_moment > 0.0:
            change = W.kappa[i] - rope.kappa0[i]
            end = 1.0 if change > 0.0 else -1.0
            stiff = (1.0 - end * rope.z0[i]) * math.exp(-abs(change) / p.dahl_curvature)
            k += ck * p.dahl_moment * stiff / (p.dahl_curvature * l)
        u0, w0 = -S[i - 1, 1] * S[i - 1, 5], S[i - 1, 0] * S[i - 1, 5]
        u2, w2 = -S[i, 1] * S[i, 5], S[i, 0] * S[i, 5]
        g = (u0, w0, -u0 - u2, -w0 - w2, u2, w2)
        for a in range(6):
            r = 2 * i - 2 + a
            ka = k * g[a]
            for b in range(6):
                A[r, 5 + b - a] += ka * g[b]
