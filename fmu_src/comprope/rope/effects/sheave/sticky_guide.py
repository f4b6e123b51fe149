"""Sticky guide of the sheave: dry friction that is larger at breakaway than in sliding.

F = (F_c + F_b exp(-(v / v_s)^2)) v / sqrt(v^2 + v_0^2) against the rise and fall, v_0 well below v_s (Stribeck's curve:
B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, *Automatica* 30, 1994).
"""

from math import exp, sqrt

from ....kernels.jit import kernel
from ....quantities import quantity
from ...parameters.parameter_vector import slot
from ...runtime.array_layout import DXX
from ..base import Effect, acts, register

CREEP = 5e-4  # m/s, v_0; as that of the guides' plain friction


class StickyGuide(Effect):
    """Guide of the sheave that sticks: breakaway needs more force than sliding."""

    name = "sticky_guide"
    breakaway_force: float = quantity(
        "N", "force of breakaway beyond that of sliding, one rope's share", 0.0, 1e4, nominal=20.0, off=0.0
    )
    sliding_force: float = quantity("N", "Coulomb force of sliding, one rope's share", 0.0, 1e4, default=0.0, nominal=10.0)
    stribeck_velocity: float = quantity("m/s", "velocity at which breakaway has faded to 37 %", 1e-3, 1.0, default=2e-3)


register(StickyGuide)
BREAKAWAY = slot("effects.sticky_guide.breakaway_force")
SLIDING = slot("effects.sticky_guide.sliding_force")
STRIBECK = slot("effects.sticky_guide.stribeck_velocity")


@kernel
def stribeck(p, v):
    """Friction [N] against a velocity, and its derivative by that velocity."""
    root, s = 1.0 / sqrt(v * v + CREEP * CREEP), v / p[STRIBECK]
    sticking = p[BREAKAWAY] * exp(-s * s)
    size = p[SLIDING] + sticking
    return size * v * root, size * CREEP * CREEP * root * root * root - 2.0 * s / p[STRIBECK] * sticking * v * root


@kernel
def stick(n, t, p, q, v, w, f):
    """Subtract the guide's friction."""
    if p[BREAKAWAY] == 0.0 and p[SLIDING] == 0.0:
        return 0.0
    force = stribeck(p, v[n])[0]
    f[n] -= force
    return -force * v[n]


@kernel
def stick_tangent(n, t, p, q, v, w, A, weights):
    """Derivative of the friction where it grows with velocity; where it falls Newton's iteration does without, to stay stable."""
    if p[BREAKAWAY] != 0.0 or p[SLIDING] != 0.0:
        A[DXX * (n + 1) + n] += weights.cc * max(stribeck(p, v[n])[1], 0.0)


acts(StickyGuide, forces=stick, tangents=stick_tangent)
