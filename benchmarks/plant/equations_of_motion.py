"""Equations (1) and (2) put together: forces at a state, tangent of one time step, and Newton's iteration."""

from .bordered_band import bordered, factor
from .jit import kernel
from .rope import inner_forces, inner_tangent, moments, segments
from .shaft import air, gravity, shaft_contact
from .sheave import contact, own_forces


@kernel
def forces(p, n, W, rope, around, q, v, by):
    """Fill W.f with all forces at q and v and, where `by` wants a tangent, the matrices of it."""
    N = 2 * n
    segments(p, n, around.thermal, q, v, W.S)
    moments(p, n, W.S, rope.kappa0, rope.z0, W.m, W.kappa)
    inner_forces(n, W.S, W.m, W.f)
    W.f[N] = W.f[N + 1] = 0.0
    if by.tangent:
        W.A[:] = 0.0
        W.B[:] = 0.0
        W.C[:] = 0.0
        W.D[:] = 0.0
        for i in range(n):
            W.A[2 * i, 5] = W.A[2 * i + 1, 5] = by.cm * rope.mass[i]
        W.D[0, 0], W.D[1, 1] = by.cm * p.sheave_mass, by.cm * p.inertia
        inner_tangent(p, n, W, rope, by)
    gravity(n, rope.mass, W.f)
    if p.drag > 0.0:
        air(p, n, W, q, v, around.wind, by)
    if p.brush_stiffness > 0.0 or p.wall_stiffness > 0.0:
        shaft_contact(p, n, W, q, v, by)
    W.tensions[0], W.tensions[1] = W.S[0, 3], W.S[n - 2, 3]
    W.tensions[2] = contact(p, n, W, q, v, by)
    own_forces(p, n, W, q, v, by)


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
