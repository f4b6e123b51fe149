"""How a rope comes to hang at rest between its ends: its mesh, a first shape, and equilibrium from there.

The array u holds the ends' inputs: what the FMU has as inputs, in the same order.
"""

from math import cos, pi, sin

from ..mechanics.effect_hooks import all_begin
from ..mechanics.end_conditions import PATH, PATHS, place_ends
from ..mechanics.energy import open_ledger
from ..mechanics.equations_of_motion import forces
from ..runtime.jit import kernel
from ..runtime.parameter_vector import ELEMENT, M, R
from ..runtime.status import FINE, NO_REST, OUT_OF_REACH
from .inputs import CAR, CAR_OUT, COUNTERWEIGHT, COUNTERWEIGHT_OUT
from .mesh import rope_length
from .newmark import copy
from .static_equilibrium import rest


@kernel
def out_of_reach(p, u, t, told):
    """Refuse ends between which the rope cannot hang; returns the kind of refusal."""
    length = rope_length(p)
    lowest = 0.5 * (u[CAR] + u[COUNTERWEIGHT] - (length - pi * p[R]))
    if min(u[CAR], u[COUNTERWEIGHT]) - lowest >= p[R]:
        return FINE
    told[0], told[1], told[2], told[3], told[4], told[5] = u[CAR], u[COUNTERWEIGHT], t, length, lowest, p[R]
    return OUT_OF_REACH


@kernel
def lay(n, p, u, q):
    """Set q to straight sides and a half circle that hold the natural length."""
    m, radius = n + 1, p[R]
    axle = 0.5 * (rope_length(p) - pi * radius - u[CAR] - u[COUNTERWEIGHT])
    left = u[CAR] + axle
    for i in range(n):
        s = i * p[ELEMENT]
        turned = min(max((s - left) / radius, 0.0), pi)
        q[i] = s - u[CAR] if s < left else axle + radius * sin(turned)
        if s > left + pi * radius:
            q[i] = axle - (s - left - pi * radius)
        q[m + i] = -radius * cos(turned)
    q[n] = axle
    q[m + n] = 0.0


@kernel
def stay(p, u, path):
    """Set a path on which the ends stay where they are."""
    for k in range(PATHS * PATH):
        path[k] = 0.0
    for at in (0, 3):
        path[at] = -u[CAR]
        path[PATH + at] = -p[R] - u[CAR_OUT]
        path[2 * PATH + at] = -u[COUNTERWEIGHT]
        path[3 * PATH + at] = p[R] + u[COUNTERWEIGHT_OUT]


@kernel
def settle(
    n, t, p, smooth, u, path, q0, v0, a0, f0, h0, f, h1, w, A, L, B, Z, r, touch, power, effects, P0, E, start, told,
):  # fmt: skip
    """Hang a rope whose state is all zero at rest; returns FINE or the kind of failure.

    `smooth` are its parameters without friction and without effects that have a history.
    """
    lay(n, p, u, q0)
    stay(p, u, path)
    place_ends(n, t, p, path, 1.0, 0.0, q0, v0, a0)
    for i in range(2 * (n + 1)):
        v0[i] = 0.0
        a0[i] = 0.0
    if rest(n, smooth, q0, v0, w, f, touch, h0, h1, power, A, L, B, Z, r, p[ELEMENT]) < 0.0:
        told[0], told[1], told[2] = u[CAR], u[COUNTERWEIGHT], p[M]
        return NO_REST
    for turn in range(2):  # once for the shape where histories begin, once with them
        forces(n, t, p, q0, v0, w, f, touch, h0, h1, power, Z, 0.0, 0.0, False)
        if turn == 0:
            all_begin(n, p, w, h0)
    copy(2 * (n + 1), f, f0)
    open_ledger(n, p, q0, v0, a0, f, w, touch, power, effects, P0, E, start)
    return FINE
