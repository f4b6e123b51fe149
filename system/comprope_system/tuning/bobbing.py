"""The sheave on the elastic rope: it turns and rises a little apart from what the ends do, and rings after each jerk.

With w (2,) how far the rope has run up where it leaves the sheave, on the car's and on the counterweight's side, e the same of
the ends, so that the sheave has risen by half the sum of w and turned by half the difference, and m = rho L, k = EA / L of each
side, its strain even along it:

    (P + m/3) w'' + m/6 e'' + c (w' - e') + k (w - e) = 0,   c = k c_A / EA

P holds the sheave with the rope on it: `lifting` for equal accelerations, `turning` for opposite ones, halved between the
sides. What presses on the groove is half the weight and P w''.
"""

import numba
import numpy as np
from numpy.typing import NDArray

from .swaying import Rope

Floats = NDArray[np.float64]

PARTS = 3  # of a step: the ringing is faster than the swing


def bobbing(rope: Rope, dt: float, length: Floats, acceleration: Floats) -> tuple[Floats, Floats]:
    """How much faster than the end the rope runs up at the sheave [m/s], and the press on the groove [N], by side (2, n).

    `length` [m] and `acceleration` [m/s2] of the ends, up positive, (2, n) at times `dt` [s] apart.
    """
    equal, opposite = 0.5 * (rope.lifting + rope.turning), 0.5 * (rope.lifting - rope.turning)
    faster, pressed = _bobbing(
        dt / PARTS, PARTS, length, acceleration, equal, opposite, rope.mass_per_length, rope.axial_stiffness, rope.axial_damping
    )
    return faster, rope.weight + pressed


@numba.njit(cache=True)
def _bobbing(h, parts, L, a, equal, opposite, rho, EA, c):  # type: ignore[no-untyped-def]
    """w' - e' and P w'' by the implicit midpoint rule, `parts` steps of h between samples."""
    n = L.shape[1]
    d, u, x, length, push = np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2)
    faster, pressed = np.zeros((2, n)), np.zeros((2, n))
    for i in range(n):
        _hurried(x, 0.0, L[:, i], a[:, i], d, u, equal, opposite, rho, EA, c)
        for side in range(2):
            other = 1 - side
            faster[side, i] = u[side]
            pressed[side, i] = equal * (a[side, i] + x[side]) + opposite * (a[other, i] + x[other])
        for j in range(parts if i < n - 1 else 0):
            share = (j + 0.5) / parts
            for side in range(2):
                length[side] = L[side, i] + share * (L[side, i + 1] - L[side, i])
                push[side] = a[side, i] + share * (a[side, i + 1] - a[side, i])
            _hurried(x, h, length, push, d, u, equal, opposite, rho, EA, c)
            for side in range(2):
                d[side] += h * (u[side] + 0.5 * h * x[side])
                u[side] += h * x[side]
    return faster, pressed


@numba.njit(cache=True)
def _hurried(x, h, L, a, d, u, equal, opposite, rho, EA, c):  # type: ignore[no-untyped-def]
    """x = d'' half a step of h on, d = w - e and u = d' where it begins."""
    lead = c / EA + 0.5 * h
    f0 = -(equal + 0.5 * rho * L[0]) * a[0] - opposite * a[1] - EA / L[0] * (d[0] + lead * u[0])
    f1 = -(equal + 0.5 * rho * L[1]) * a[1] - opposite * a[0] - EA / L[1] * (d[1] + lead * u[1])
    m0 = equal + rho * L[0] / 3.0 + 0.5 * h * lead * EA / L[0]
    m1 = equal + rho * L[1] / 3.0 + 0.5 * h * lead * EA / L[1]
    size = m0 * m1 - opposite * opposite
    x[0], x[1] = (m1 * f0 - opposite * f1) / size, (m0 * f1 - opposite * f0) / size
