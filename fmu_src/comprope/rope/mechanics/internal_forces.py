"""Tension, bending, damping and gravity of eq. (1): forces on the nodes and their tangent.

The rope is a polygon of elements of natural length l. Segment e has tangent t and normal
n = (-t_y, t_x); its tension is T = EA (L/l - 1) + c_A rate and its shear Q = (M_e - M_e+1) / L,
where M = EI kappa + c_B dkappa/dt and kappa is the angle between neighbouring segments over l.
Node i then feels the difference of F = T t + Q n over its two segments (T and B of the paper, with
their damping), gravity, and an external damping proportional to velocity (D).

Each loop writes one quantity, so that the compiler can use the processor's vector units.

Read as point values r of a curve r + l^2/24 r'', tension and bending of the polygon agree with the
continuous rope up to fourth order; the contact is placed to match (see `sheave_contact`).

The tangent leaves out how the damping forces turn with the rope: less than 3e-3 of the stiffness, which
Newton's iteration does not notice.
"""

from math import sqrt

from ..runtime.array_layout import (
    BEND_RATE,
    BENDING,
    CURVATURE,
    DXX,
    DXY,
    DYY,
    EXX,
    EXY,
    EYX,
    EYY,
    FX,
    FY,
    GXX,
    GXY,
    GYX,
    GYY,
    INVERSE,
    MOMENT,
    SHEAR,
    SPIN,
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
from ..runtime.jit import kernel
from ..runtime.parameter_vector import CA, CB, CE, EA, EI, ELEMENT, RHO, G


@kernel
def angle(sine):
    """Angle [rad] from its sine, arcsin to its ninth order: 2e-9 of the angle at 0.2 rad."""
    s2 = sine * sine
    return sine * (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (15.0 / 336.0 + s2 * 105.0 / 3456.0))))


@kernel
def stretch(n, p, q, v, w):
    """Tangent, tension and spin of each segment; T = EA strain + c_A strain rate."""
    m, l = n + 1, p[ELEMENT]
    for e in range(n - 1):
        dx, dy = q[e + 1] - q[e], q[m + e + 1] - q[m + e]
        vx, vy = v[e + 1] - v[e], v[m + e + 1] - v[m + e]
        L = sqrt(dx * dx + dy * dy)
        inverse = 1.0 / L
        tx, ty = dx * inverse, dy * inverse
        w[TX * m + e] = tx
        w[TY * m + e] = ty
        w[INVERSE * m + e] = inverse
        w[TENSION * m + e] = (p[EA] * (L - l) + p[CA] * (tx * vx + ty * vy)) / l
        w[SPIN * m + e] = (tx * vy - ty * vx) * inverse


@kernel
def bend(n, p, w):
    """Curvature and moment at each inner node; M = EI kappa + c_B dkappa/dt. The pinned ends carry none."""
    m, per_l = n + 1, 1.0 / p[ELEMENT]
    for i in range(1, n - 1):
        w[CURVATURE * m + i] = angle(w[TX * m + i - 1] * w[TY * m + i] - w[TY * m + i - 1] * w[TX * m + i]) * per_l
    for i in range(1, n - 1):
        w[BEND_RATE * m + i] = (w[SPIN * m + i] - w[SPIN * m + i - 1]) * per_l
    for i in range(1, n - 1):
        w[MOMENT * m + i] = p[EI] * w[CURVATURE * m + i] + p[CB] * w[BEND_RATE * m + i]
    for i in range(1, n - 1):
        w[STIFF * m + i] = 0.0


@kernel
def sum_forces(n, p, v, w, f):
    """Right-hand side of eq. (1) without contact: f = T + B - D + G; sets f for all nodes."""
    m = n + 1
    weight, drag = p[RHO] * p[ELEMENT] * p[G], p[CE] * p[ELEMENT]
    for e in range(n - 1):
        w[SHEAR * m + e] = (w[MOMENT * m + e] - w[MOMENT * m + e + 1]) * w[INVERSE * m + e]
    for e in range(n - 1):
        w[FX * m + e] = w[TENSION * m + e] * w[TX * m + e] - w[SHEAR * m + e] * w[TY * m + e]
    for e in range(n - 1):
        w[FY * m + e] = w[TENSION * m + e] * w[TY * m + e] + w[SHEAR * m + e] * w[TX * m + e]
    f[0] = w[FX * m] + 0.5 * weight
    f[m] = w[FY * m]
    for i in range(1, n - 1):
        f[i] = w[FX * m + i] - w[FX * m + i - 1] + weight - drag * v[i]
    for i in range(1, n - 1):
        f[m + i] = w[FY * m + i] - w[FY * m + i - 1] - drag * v[m + i]
    f[n - 1] = -w[FX * m + n - 2] + 0.5 * weight
    f[m + n - 1] = -w[FY * m + n - 2]


@kernel
def segment_blocks(n, p, w, ck, cc):
    """Stiffness of each segment: k_a t t' + T/L n n' - Q/L (n t' + t n'), weighted by ck and cc."""
    m = n + 1
    along = (ck * p[EA] + cc * p[CA]) / p[ELEMENT]
    for e in range(n - 1):
        tx, ty, inverse = w[TX * m + e], w[TY * m + e], w[INVERSE * m + e]
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
def hold_ends(n, A):
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
