"""Tangent of tension, bending, damping and gravity: stiffness of segments and nodes, summed into the block band.

It belongs to the state in which `internal_forces` has set the workspace w.

The tangent leaves out how the damping forces turn with the rope: less than 3e-3 of the stiffness, which
Newton's iteration does not notice.
"""

from ...kernels.jit import kernel
from ..parameters.parameter_vector import CA, CB, CE, EA, EI, ELEMENT, RHO
from ..runtime.array_layout import (
    BENDING,
    DXX,
    DXY,
    DYY,
    EXX,
    EXY,
    EYX,
    EYY,
    GXX,
    GXY,
    GYX,
    GYY,
    INVERSE,
    SHARE,
    SHEAR,
    STIFF,
    SXX,
    SXY,
    SYY,
    TENSION,
    TX,
    TY,
    WX,
    WY,
)


@kernel
def segment_blocks(n, p, w, ck, cc):
    """Stiffness of each segment: k_a t t' + T/L n n' - Q/L (n t' + t n'), weighted by ck and cc."""
    m = n + 1
    rod = (ck * p[EA] + cc * p[CA]) / p[ELEMENT]
    for e in range(n - 1):
        tx, ty, inverse = w[TX * m + e], w[TY * m + e], w[INVERSE * m + e]
        along = rod * w[SHARE * m + e]
        across, twist = ck * w[TENSION * m + e] * inverse, -ck * w[SHEAR * m + e] * inverse
        w[SXX * m + e] = along * tx * tx + across * ty * ty - 2.0 * twist * tx * ty
        w[SXY * m + e] = (along - across) * tx * ty + twist * (tx * tx - ty * ty)
        w[SYY * m + e] = along * ty * ty + across * tx * tx + 2.0 * twist * tx * ty
        w[WX * m + e] = -ty * inverse
        w[WY * m + e] = tx * inverse


@kernel
def bending_stiffness(n, p, w, ck, cc):
    """Add EI and c_B to each inner node's stiffness against bending; the pinned ends have none."""
    m, per_l = n + 1, 1.0 / p[ELEMENT]
    for i in range(1, n - 1):
        w[BENDING * m + i] = (ck * (p[EI] + w[STIFF * m + i]) + cc * p[CB]) * per_l
    w[BENDING * m] = 0.0
    w[BENDING * m + n - 1] = 0.0


@kernel
def assemble(n, p, w, A, mass, cc):
    """Sum `mass` times the inertia, segments and bending of inner nodes into the block band A.

    Node i's bending has the gradient (w_-, -(w_- + w_+), w_+) over its three nodes, where w is the
    gradient of a segment's angle. Rows of the prescribed ends stay the identity.
    """
    inertia = (mass * p[RHO] + cc * p[CE]) * p[ELEMENT]
    sum_diagonal(n, w, A, DXX, WX, WX, SXX, inertia)
    sum_diagonal(n, w, A, DXY, WX, WY, SXY, 0.0)
    sum_diagonal(n, w, A, DYY, WY, WY, SYY, inertia)
    sum_next(n, w, A, EXX, WX, WX, SXX)
    sum_next(n, w, A, EXY, WX, WY, SXY)
    sum_next(n, w, A, EYX, WY, WX, SXY)
    sum_next(n, w, A, EYY, WY, WY, SYY)
    sum_after(n, w, A, GXX, WX, WX)
    sum_after(n, w, A, GXY, WX, WY)
    sum_after(n, w, A, GYX, WY, WX)
    sum_after(n, w, A, GYY, WY, WY)


@kernel
def sum_diagonal(n, w, A, to, u, v, S, inertia):
    """One entry of the blocks of nodes with themselves: u and v are the sections of its row's and column's w."""
    m = n + 1
    k, u, v, S, to = BENDING * m, u * m, v * m, S * m, to * m
    for i in range(1, n - 1):
        before, after = w[k + i - 1] * w[u + i - 1] * w[v + i - 1], w[k + i + 1] * w[u + i] * w[v + i]
        own = w[k + i] * (w[u + i - 1] + w[u + i]) * (w[v + i - 1] + w[v + i])
        A[to + i] = inertia + w[S + i - 1] + w[S + i] + before + own + after


@kernel
def sum_next(n, w, A, to, u, v, S):
    """One entry of the blocks of nodes with the next."""
    m = n + 1
    k, u, v, S, to = BENDING * m, u * m, v * m, S * m, to * m
    for i in range(1, n - 2):
        own = w[k + i] * (w[u + i - 1] + w[u + i]) * w[v + i]
        A[to + i] = -w[S + i] - own - w[k + i + 1] * w[u + i] * (w[v + i] + w[v + i + 1])


@kernel
def sum_after(n, w, A, to, u, v):
    """One entry of the blocks of nodes with the one after the next."""
    m = n + 1
    k, u, v, to = BENDING * m, u * m, v * m, to * m
    for i in range(1, n - 2):
        A[to + i] = w[k + i + 1] * w[u + i] * w[v + i + 1]


@kernel
def fix_end_rows(n, A):
    """Make the rows of the prescribed ends the identity and uncouple them."""
    m = n + 1
    for k in range(EXX, GYY + 1):
        A[k * m] = 0.0
        A[k * m + n - 2] = 0.0
        A[k * m + n - 1] = 0.0
    for k in range(GXX, GYY + 1):
        A[k * m + n - 3] = 0.0
    for i in (0, n - 1):
        A[DXX * m + i] = 1.0
        A[DXY * m + i] = 0.0
        A[DYY * m + i] = 1.0
