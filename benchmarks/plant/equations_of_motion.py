"""Equations (1) and (2) put together: forces at a state, tangent of one time step, and Newton's iteration."""

from typing import NamedTuple

import numpy as np

from .bordered_band import bordered, factor
from .jit import kernel
from .rope import inner_forces, inner_tangent, moments, segments
from .shaft import air, gravity, shaft_contact
from .sheave import contact, own_forces
from .tower import Floats


class Work(NamedTuple):
    """Arrays that the equations fill; n nodes."""

    S: Floats  # [n, 6] segments
    m: Floats  # [n] moments
    kappa: Floats  # [n]
    f: Floats  # [2 n + 2]
    A: Floats  # [2 n + 5, 11]
    B: Floats  # [2, 2 n + 10]
    C: Floats  # [2, 2 n]
    D: Floats  # [2, 2]
    E: Floats  # [2, 2]
    x: Floats  # [2 n + 10]
    tensions: Floats  # [3] at the car, at the counterweight, and the sheave's force


def work(n: int) -> Work:
    """Room for a rope of n nodes."""
    zeros = np.zeros
    return Work(
        zeros((n, 6)), zeros(n), zeros(n), zeros(2 * n + 2), zeros((2 * n + 5, 11)), zeros((2, 2 * n + 10)),
        zeros((2, 2 * n)), zeros((2, 2)), zeros((2, 2)), zeros(2 * n + 10), zeros(3),
    )  # fmt: skip


@kernel
def forces(p, n, W, mass, kappa0, z0, thermal, wind, q, v, ck, cc, cm, tangent):
    """Fill W.f with all forces and, with `tangent`, the matrices with cm M + ck K + cc C."""
    N = 2 * n
    segments(p, n, thermal, q, v, W.S)
    moments(p, n, W.S, kappa0, z0, W.m, W.kappa)
    inner_forces(n, W.S, W.m, W.f)
    W.f[N] = W.f[N + 1] = 0.0
    if tangent:
        W.A[:] = 0.0
        W.B[:] = 0.0
        W.C[:] = 0.0
        W.D[:] = 0.0
        for i in range(n):
            W.A[2 * i, 5] = W.A[2 * i + 1, 5] = cm * mass[i]
        W.D[0, 0], W.D[1, 1] = cm * p.sheave_mass, cm * p.inertia
        inner_tangent(p, n, W.S, W.m, W.kappa, kappa0, z0, ck, cc, W.A)
    gravity(n, mass, W.f)
    if p.drag > 0.0:
        air(p, n, W.S, q, v, W.f, cc, wind, tangent, W.A)
    if p.brush_stiffness > 0.0 or p.wall_stiffness > 0.0:
        shaft_contact(p, n, q, v, W.f, ck, cc, tangent, W.A)
    W.tensions[0], W.tensions[1] = W.S[0, 3], W.S[n - 2, 3]
    W.tensions[2] = contact(p, n, q, v, W.f, ck, cc, tangent, W.A, W.B, W.C, W.D)
    own_forces(p, q, v, N, W.f, ck, cc, tangent, W.D)


@kernel
def hold_ends(n, W, tangent):
    """Prescribed ends: no correction, unit rows of the tangent."""
    N = 2 * n
    for k in (0, 1, N - 2, N - 1):
        W.x[5 + k] = 0.0
    if tangent:
        for k in (0, 1, N - 2, N - 1):
            for j in range(11):
                W.A[k, j] = 0.0
        for k in (0, 1, N - 2, N - 1, N, N + 1, N + 2, N + 3, N + 4):
            W.A[k, 5] = 1.0


@kernel
def correction(n, W, tangent):
    """Turn the imbalance in W.x into a correction of the state; its largest displacement [m or rad] is returned."""
    hold_ends(n, W, tangent)
    if tangent:
        factor(W.A, 2 * n)
    bordered(W.A, 2 * n, W.B, W.C, W.D, W.E, W.x, tangent)
    largest = 0.0
    for k in range(2 * n + 2):
        largest = max(largest, abs(W.x[5 + k]))
    return largest
