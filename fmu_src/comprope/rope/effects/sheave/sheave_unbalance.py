"""Unbalance of the sheave: a mass off the axle, whose weight turns the sheave and whose centrifugal force lifts it.

With the unbalance U = m e at the angle phi = theta + phase from straight down towards the car,

    F = U omega^2 cos(phi)  down on the axle,   T = -U g sin(phi)  on the sheave

(S. Rao, *Mechanical Vibrations*, rotating unbalance). Left out is how the accelerations of axle and sheave couple through U: that
of the axle is small beside g, and that of the sheave beside omega^2 at speed. Sideways the guides carry it.
"""

from math import cos, pi, sin

from ....kernels.jit import kernel
from ....quantities import quantity
from ...parameters.parameter_vector import G, slot
from ...runtime.array_layout import DYY
from ..base import Effect, acts, register


class SheaveUnbalance(Effect):
    """Unbalanced mass of the sheave."""

    name = "sheave_unbalance"
    proportional = True
    polar = ("unbalance", "phase")
    unbalance: float = quantity(
        "kg.m", "mass times its distance from the axle, one rope's share", 0.0, 100.0, nominal=0.1, off=0.0
    )
    phase: float = quantity(
        "rad", "direction of that mass at the start, from straight down towards the car", -2 * pi, 2 * pi,
        default=0.0, nominal=1.0,
    )  # fmt: skip


register(SheaveUnbalance)
UNBALANCE = slot("effects.sheave_unbalance.unbalance")
PHASE = slot("effects.sheave_unbalance.phase")


@kernel
def whirl(n, t, p, q, v, w, f):
    """Add the centrifugal force on the axle and the torque of the weight."""
    if p[UNBALANCE] == 0.0:
        return 0.0
    spin, turned = v[2 * n + 1], q[2 * n + 1] + p[PHASE]
    force, torque = p[UNBALANCE] * spin * spin * cos(turned), -p[UNBALANCE] * p[G] * sin(turned)
    f[n] += force
    f[2 * n + 1] += torque
    return force * v[n] + torque * spin


@kernel
def whirl_tangent(n, t, p, q, v, w, A, weights):
    """Stiffness of the weight; how the force on the axle changes with the sheave's rotation is left out: it is not symmetric."""
    if p[UNBALANCE] != 0.0:
        A[DYY * (n + 1) + n] += weights.ck * p[UNBALANCE] * p[G] * cos(q[2 * n + 1] + p[PHASE])


acts(SheaveUnbalance, forces=whirl, tangents=whirl_tangent)
