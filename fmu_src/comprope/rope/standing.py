"""How a rope comes to hang at rest between its ends: its mesh, a first shape, and equilibrium from there.

The array u holds the ends' inputs: what the FMU has as inputs, in the same order.
"""

from math import cos, pi, sin, sqrt

from .dynamics import forces
from .ends import PATH, PATHS, place_ends
from .hooks import all_begin
from .jit import kernel
from .ledger import open_ledger
from .newmark import copy
from .slots import EI, ELEMENT, HEIGHT, PIT, G, K, M, R, slot
from .statics import rest
from .words import FINE, NO_REST, OUT_OF_REACH, TOO_COARSE

LENGTH = slot("rope.element_length")
FEWEST = 16  # elements

# Inputs of the ends: heights [m], velocities, accelerations (up positive), outward displacements [m].
CAR, COUNTERWEIGHT, CAR_V, CAR_A, COUNTERWEIGHT_V, COUNTERWEIGHT_A, CAR_OUT, COUNTERWEIGHT_OUT = range(8)
INPUTS = 8


@kernel
def rope_length(p):
    """Natural length of the rope [m]."""
    return 2.0 * p[PIT] + p[HEIGHT] + pi * p[R]


@kernel
def cut_off(p, l):
    """By how much chords of length l are shorter than the rope where it bends on to the sheave and off it [m].

    To second order in l the energy of the polygon differs from that of the rope by -T l^2 (2 L + A) / (48 R^2), where
    T = M g / 2, L = (EI / T)^(1/2) is the length in which the free rope straightens, and A = (4 EI / k)^(1/4) that in
    which it sinks into the groove. Its derivative by the sheave's weight 2 T is how much too low the sheave would hang,
    l^2 (L + A) / (96 R^2): half of this length. From L = 2^(1/2) R on the rope hangs as a loop wider than the sheave, whose
    length chords have right.
    """
    straightens, sinks = sqrt(2.0 * p[EI] / (p[M] * p[G])), sqrt(sqrt(4.0 * p[EI] / p[K]))
    if straightens > sqrt(2.0) * p[R]:
        return 0.0
    return l * l * (straightens + sinks) / (48.0 * p[R] * p[R])


@kernel
def element_length(p, elements):
    """Natural length of each element [m], so many on the whole rope."""
    length = rope_length(p)
    return (length - cut_off(p, length / elements)) / elements


@kernel
def divide(p):
    """Set the length of whole elements that make up the rope; returns the number of nodes."""
    elements = max(round(rope_length(p) / p[LENGTH]), FEWEST)
    p[ELEMENT] = element_length(p, elements)
    return elements + 1.0


@kernel
def coarse(p, told):
    """Refuse elements too long to lie round the sheave; returns the kind of refusal."""
    told[0], told[1] = p[LENGTH], p[R]
    return TOO_COARSE if p[LENGTH] > 0.5 * p[R] else FINE


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
