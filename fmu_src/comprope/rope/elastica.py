"""Tension, bending, damping and gravity of eq. (1): forces on the nodes and their tangent.

The rope is a polygon of elements of natural length l. Segment e has tangent t and normal
n = (-t_y, t_x); its tension is T = EA (L/l - 1) + c_A rate and its shear Q = (M_e - M_e+1) / L,
where M = EI kappa + c_B dkappa/dt and kappa is the angle between neighbouring segments over l.
Node i then feels the difference of F = T t + Q n over its two segments (T and B of the paper, with
their damping), gravity, and an external damping proportional to velocity (D).

Read as point values r of a curve r + l^2/24 r'', tension and bending of the polygon agree with the
continuous rope up to fourth order; the contact is placed to match (see `contact`).
"""

from math import sqrt

from .jit import kernel
from .slots import CA, CB, CE, EA, EI, ELEMENT, RHO, G
from .work import (
    BEND_RATE, BENDING, CURVATURE, DXX, DXY, DYY, EXX, EXY, EYX, EYY, FX, FY, GXX, GXY, GYX, GYY, INVERSE,
    MOMENT, SHEAR, SPIN, STIFF, SXX, SXY, SYY, TENSION, TX, TY, WX, WY,
)  # fmt: skip


@kernel
def angle(sine):
    """Angle [rad] from its sine, arcsin to its ninth order: 1e-10 of the angle at 0.2 rad."""
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
        sine = w[TX * m + i - 1] * w[TY * m + i] - w[TY * m + i - 1] * w[TX * m + i]
        kappa = angle(sine) * per_l
        rate = (w[SPIN * m + i] - w[SPIN * m + i - 1]) * per_l
        w[CURVATURE * m + i] = kappa
        w[BEND_RATE * m + i] = rate
        w[MOMENT * m + i] = p[EI] * kappa + p[CB] * rate
        w[STIFF * m + i] = 0.0


@kernel
def sum_forces(n, p, v, w, f):
    """Right-hand side of eq. (1) without contact: f = T + B - D + G; sets f for all nodes."""
    m = n + 1
    weight, drag = p[RHO] * p[ELEMENT] * p[G], p[CE] * p[ELEMENT]
    for e in range(n - 1):
        T, tx, ty = w[TENSION * m + e], w[TX * m + e], w[TY * m + e]
        Q = (w[MOMENT * m + e] - w[MOMENT * m + e + 1]) * w[INVERSE * m + e]
        w[SHEAR * m + e] = Q
        w[FX * m + e] = T * tx - Q * ty
        w[FY * m + e] = T * ty + Q * tx
    f[0] = w[FX * m] + 0.5 * weight
    f[m] = w[FY * m]
    for i in range(1, n - 1):
        f[i] = w[FX * m + i] - w[FX * m + i - 1] + weight - drag * v[i]
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
    m = n + 1
    inertia = (mass * p[RHO] + cc * p[CE]) * p[ELEMENT]
    for i in range(1, n - 1):
        ax, ay, bx, by = w[WX * m + i - 1], w[WY * m + i - 1], w[WX * m + i], w[WY * m + i]
        k0, k1, k2 = w[BENDING * m + i - 1], w[BENDING * m + i], w[BENDING * m + i + 1]
        sx, sy = ax + bx, ay + by
        A[DXX * m + i] = inertia + w[SXX * m + i - 1] + w[SXX * m + i] + k0 * ax * ax + k1 * sx * sx + k2 * bx * bx
        A[DXY * m + i] = w[SXY * m + i - 1] + w[SXY * m + i] + k0 * ax * ay + k1 * sx * sy + k2 * bx * by
        A[DYY * m + i] = inertia + w[SYY * m + i - 1] + w[SYY * m + i] + k0 * ay * ay + k1 * sy * sy + k2 * by * by
        if i < n - 2:
            cx, cy = w[WX * m + i + 1], w[WY * m + i + 1]
            ux, uy = bx + cx, by + cy
            A[EXX * m + i] = -w[SXX * m + i] - k1 * sx * bx - k2 * bx * ux
            A[EXY * m + i] = -w[SXY * m + i] - k1 * sx * by - k2 * bx * uy
            A[EYX * m + i] = -w[SXY * m + i] - k1 * sy * bx - k2 * by * ux
            A[EYY * m + i] = -w[SYY * m + i] - k1 * sy * by - k2 * by * uy
            A[GXX * m + i] = k2 * bx * cx
            A[GXY * m + i] = k2 * bx * cy
            A[GYX * m + i] = k2 * by * cx
            A[GYY * m + i] = k2 * by * cy


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
