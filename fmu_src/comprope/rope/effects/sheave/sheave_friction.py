"""Friction and damping of the sheave's motion: bearing, guides, and a tie-down damper.

Coulomb forces are regularised, F = F_c v / sqrt(v^2 + v_0^2), with v_0 well below working speeds.
"""

from math import sqrt
from typing import ClassVar

from ....kernels.jit import kernel
from ....quantities import quantity
from ...parameters.parameter_vector import slot
from ...runtime.array_layout import DXX, DYY
from ..base import Effect, acts, register

TURN0 = 0.01  # rad/s
LIFT0 = 5e-4  # m/s


class BearingFriction(Effect):
    """Friction torque of the sheave's bearing and seals."""

    name = "bearing_friction"
    coulomb_torque: float = quantity("N.m", "Coulomb torque", 0.0, 1000.0, nominal=5.0, off=0.0)
    viscous: float = quantity("N.m.s", "torque per angular velocity", 0.0, 100.0, default=0.0, nominal=0.1)


class GuideFriction(Effect):
    """Dry friction of the sheave's guides."""

    name = "guide_friction"
    coulomb_force: float = quantity("N", "Coulomb force on the sheave's vertical motion", 0.0, 10000.0, nominal=20.0, off=0.0)


class SheaveDamper(Effect):
    """A tie-down damper on the sheave."""

    name = "sheave_damper"
    probes: ClassVar[dict[str, tuple[float, ...]]] = {"damping": (1e3, 1e4, 1e5)}
    damping: float = quantity("N.s/m", "force per vertical velocity of the sheave", 0.0, 1e7, nominal=1e4, off=0.0)


for _effect in (BearingFriction, GuideFriction, SheaveDamper):
    register(_effect)
TORQUE = slot("effects.bearing_friction.coulomb_torque")
VISCOUS = slot("effects.bearing_friction.viscous")
GUIDE = slot("effects.guide_friction.coulomb_force")
DAMPER = slot("effects.sheave_damper.damping")


@kernel
def sign(v, v0):
    """Smooth sign of v and its derivative."""
    root = 1.0 / sqrt(v * v + v0 * v0)
    return v * root, v0 * v0 * root * root * root


@kernel
def bearing(n, t, p, q, v, w, f):
    """Subtract the bearing's torque."""
    spin = v[2 * n + 1]
    torque = p[TORQUE] * sign(spin, TURN0)[0] + p[VISCOUS] * spin
    f[2 * n + 1] -= torque
    return -torque * spin


@kernel
def bearing_tangent(n, t, p, q, v, w, A, weights):
    """Derivative of the bearing's torque by angular velocity."""
    A[DYY * (n + 1) + n] += weights.cc * (p[TORQUE] * sign(v[2 * n + 1], TURN0)[1] + p[VISCOUS])


@kernel
def guide(n, t, p, q, v, w, f):
    """Subtract the guides' friction."""
    force = p[GUIDE] * sign(v[n], LIFT0)[0]
    f[n] -= force
    return -force * v[n]


@kernel
def guide_tangent(n, t, p, q, v, w, A, weights):
    """Derivative of the guides' friction by velocity."""
    A[DXX * (n + 1) + n] += weights.cc * p[GUIDE] * sign(v[n], LIFT0)[1]


@kernel
def damper(n, t, p, q, v, w, f):
    """Subtract the damper's force."""
    f[n] -= p[DAMPER] * v[n]
    return -p[DAMPER] * v[n] * v[n]


@kernel
def damper_tangent(n, t, p, q, v, w, A, weights):
    """The damper's constant."""
    A[DXX * (n + 1) + n] += weights.cc * p[DAMPER]


acts(BearingFriction, forces=bearing, tangents=bearing_tangent)
acts(GuideFriction, forces=guide, tangents=guide_tangent)
acts(SheaveDamper, forces=damper, tangents=damper_tangent)
