"""Jammed seal and jammed guide of the sheave: springs (Hooke's law) on its angle and on its height.

    seal:   T = -k theta           grows with the angle turned since the start: the lip sticks to the shaft and is twisted
    guide:  F = -k (x_s - pit)     grows with the distance of the axle from the height where it is built: a bent or narrowing
                                   rail, a jammed guide shoe, or a packing that is sheared instead of sliding
"""

from ....kernels.jit import kernel
from ....quantities import quantity
from ...parameters.parameter_vector import PIT, slot
from ...runtime.array_layout import DXX, DYY
from ..base import Effect, acts, register


class JammedSeal(Effect):
    """Bearing seal that winds up as the sheave turns."""

    name = "jammed_seal"
    proportional = True
    stiffness: float = quantity(
        "N.m/rad", "torque per angle turned since the start, one rope's share", 0.0, 1000.0, nominal=0.05, off=0.0
    )


class JammedGuide(Effect):
    """Guide of the sheave whose resistance depends on the height."""

    name = "jammed_guide"
    proportional = True
    stiffness: float = quantity(
        "N/m", "vertical force per distance of the axle from where it is built, one rope's share", 0.0, 1e8, nominal=1e4, off=0.0
    )


register(JammedSeal)
register(JammedGuide)
SEAL = slot("effects.jammed_seal.stiffness")
GUIDE = slot("effects.jammed_guide.stiffness")


@kernel
def spring_back(k, origin, i, q, v, f):
    """Subtract the force of a spring of stiffness k on coordinate i of the sheave; its power [W]."""
    force = k * (q[i] - origin)
    f[i] -= force
    return -force * v[i]


@kernel
def wind_up(n, t, p, q, v, w, f):
    """Subtract the seal's torque."""
    return spring_back(p[SEAL], 0.0, 2 * n + 1, q, v, f)


@kernel
def wind_up_tangent(n, t, p, q, v, w, A, weights):
    """The seal's stiffness."""
    A[DYY * (n + 1) + n] += weights.ck * p[SEAL]


@kernel
def jam(n, t, p, q, v, w, f):
    """Subtract the guide's force."""
    return spring_back(p[GUIDE], p[PIT], n, q, v, f)


@kernel
def jam_tangent(n, t, p, q, v, w, A, weights):
    """The guide's stiffness."""
    A[DXX * (n + 1) + n] += weights.ck * p[GUIDE]


acts(JammedSeal, forces=wind_up, tangents=wind_up_tangent)
acts(JammedGuide, forces=jam, tangents=jam_tangent)
