"""Jammed seal of the sheave's bearing: it winds up, and its torque grows with the angle turned since the start.

T = -k theta, a torsional spring (Hooke's law): the seal's lip sticks to the shaft and is twisted instead of sliding.
"""

from ....kernels.jit import kernel
from ....quantities import quantity
from ...runtime.array_layout import DYY
from ...runtime.parameter_vector import slot
from ..base import Effect, acts, register


class JammedSeal(Effect):
    """Bearing seal that winds up as the sheave turns."""

    name = "jammed_seal"
    proportional = True
    stiffness: float = quantity(
        "N.m/rad", "torque per angle turned since the start, one rope's share", 0.0, 1000.0, nominal=0.05, off=0.0
    )


register(JammedSeal)
STIFFNESS = slot("effects.jammed_seal.stiffness")


@kernel
def wind_up(n, t, p, q, v, w, f):
    """Subtract the seal's torque."""
    torque = p[STIFFNESS] * q[2 * n + 1]
    f[2 * n + 1] -= torque
    return -torque * v[2 * n + 1]


@kernel
def wind_up_tangent(n, t, p, q, v, w, A, weights):
    """The seal's stiffness."""
    A[DYY * (n + 1) + n] += weights.ck * p[STIFFNESS]


acts(JammedSeal, forces=wind_up, tangents=wind_up_tangent)
