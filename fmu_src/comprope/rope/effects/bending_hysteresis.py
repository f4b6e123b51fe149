"""Bending hysteresis by friction between wires: a Dahl moment in addition to the elastic one.

M = M_f z with dz = (dkappa - |dkappa| z) / kappa_y, so that z runs to +-1 (Dahl 1976). Within a step the
curvature is taken as monotonic and z is integrated exactly. z is zero in the shape the rope hangs in
at the start.
"""

from math import exp
from typing import ClassVar

from ...kernels.jit import kernel
from ...quantities import quantity
from ..parameters.parameter_vector import ELEMENT, slot
from ..runtime.array_layout import BEND_RATE, CURVATURE, MOMENT, STIFF
from .base import Effect, acts, register


class BendingHysteresis(Effect):
    """Dry friction between the wires when the rope bends."""

    name = "bending_hysteresis"
    states = 2
    probes: ClassVar[dict[str, tuple[float, ...]]] = {"yield_curvature": (0.02, 0.1, 0.5, 2.0)}
    friction_moment: float = quantity("N.m", "moment of full slip between the wires", 0.0, 500.0, nominal=1.0, off=0.0)
    yield_curvature: float = quantity("1/m", "curvature over which slip develops", 1e-4, 10.0, nominal=0.1, off=0.1)


register(BendingHysteresis)
MF = slot("effects.bending_hysteresis.friction_moment")
KY = slot("effects.bending_hysteresis.yield_curvature")
KAPPA0 = BendingHysteresis.first_state
SLIP = KAPPA0 + 1


@kernel
def dahl(z, change, yielding):
    """Slip variable after the curvature has changed by `change`, and its derivative by that change."""
    sense = 1.0 if change >= 0.0 else -1.0
    fade = exp(-abs(change) / yielding)
    return sense + (z - sense) * fade, (1.0 - sense * z) * fade / yielding


@kernel
def wire_friction(n, p, w, h0, h1):
    """Add the friction moment of every inner node and keep its history."""
    if p[MF] == 0.0:
        return 0.0
    m, power = n + 1, 0.0
    for i in range(1, n - 1):
        kappa = w[CURVATURE * m + i]
        z, by_kappa = dahl(h0[SLIP * m + i], kappa - h0[KAPPA0 * m + i], p[KY])
        h1[KAPPA0 * m + i] = kappa
        h1[SLIP * m + i] = z
        w[MOMENT * m + i] += p[MF] * z
        w[STIFF * m + i] += p[MF] * by_kappa
        power -= p[MF] * z * w[BEND_RATE * m + i] * p[ELEMENT]
    return power


@kernel
def unstrained(n, p, w, h0):
    """Begin without slip in the curvature at rest."""
    m = n + 1
    for i in range(1, n - 1):
        h0[KAPPA0 * m + i] = w[CURVATURE * m + i]
        h0[SLIP * m + i] = 0.0


acts(BendingHysteresis, moments=wire_friction, begin=unstrained)
