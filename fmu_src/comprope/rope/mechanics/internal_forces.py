"""Tension, bending, damping and gravity of eq. (1): forces on the nodes.

The rope is a polygon of elements of natural length l. Segment e has tangent t and normal
n = (-t_y, t_x); its tension is T = EA (L/l - 1) + c_A rate, less where that would push (see `axial_law`), and its
shear Q = (M_e - M_e+1) / L, where M = EI kappa + c_B dkappa/dt and kappa is the angle between neighbouring segments over l.
Node i then feels the difference of F = T t + Q n over its two segments (T and B of the paper, with
their damping), gravity, and an external damping proportional to velocity (D).

Each loop writes one quantity, so that the compiler can use the processor's vector units.

Read as point values r of a curve r + l^2/24 r'', tension and bending of the polygon agree with the
continuous rope up to fourth order; the contact is placed to match (see `sheave_contact`).
"""

from math import sqrt

from ...kernels.jit import kernel
from ..parameters.parameter_vector import CA, CB, CE, EA, EI, ELEMENT, RATIO, RHO, G
from ..runtime.array_layout import BEND_RATE, CURVATURE, FX, FY, INVERSE, MOMENT, SHARE, SHEAR, SPIN, STIFF, TENSION, TX, TY
from .axial_law import relieve_compression


@kernel
def angle(sine):
    """Angle [rad] from its sine, arcsin to its ninth order: 2e-9 of the angle at 0.2 rad."""
    s2 = sine * sine
    return sine * (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (15.0 / 336.0 + s2 * 105.0 / 3456.0))))


@kernel
def stretch(n, p, q, v, w):
    """Tangent, tension and spin of each segment; T = EA strain + c_A strain rate, less in compression."""
    m, l, loose = n + 1, p[ELEMENT], 0
    for e in range(n - 1):
        dx, dy = q[e + 1] - q[e], q[m + e + 1] - q[m + e]
        vx, vy = v[e + 1] - v[e], v[m + e + 1] - v[m + e]
        L = sqrt(dx * dx + dy * dy)
        inverse = 1.0 / L
        tx, ty = dx * inverse, dy * inverse
        w[TX * m + e] = tx
        w[TY * m + e] = ty
        w[INVERSE * m + e] = inverse
        tension = (p[EA] * (L - l) + p[CA] * (tx * vx + ty * vy)) / l
        w[TENSION * m + e] = tension
        w[SHARE * m + e] = 1.0
        loose += (tension < 0.0) | (l > L)
        w[SPIN * m + e] = (tx * vy - ty * vx) * inverse
    w[SHARE * m + n] = loose
    if loose > 0 and p[RATIO] != 1.0:
        relieve_compression(n, p, w)


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
