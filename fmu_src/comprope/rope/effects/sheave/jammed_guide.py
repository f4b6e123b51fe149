"""Jammed guide of the sheave: a force on the axle that grows with its distance from the height where it is built.

F = -k (x_s - pit), a spring (Hooke's law): a bent or narrowing rail, a jammed guide shoe, or a packing that is sheared instead of
sliding.
"""

from ....kernels.jit import kernel
from ....quantities import quantity
from ...runtime.array_layout import DXX
from ...runtime.parameter_vector import PIT, slot
from ..base import Effect, acts, register


class JammedGuide(Effect):
    """Guide of the sheave whose resistance depends on the height."""

    name = "jammed_guide"
    proportional = True
    stiffness: float = quantity(
        "N/m", "vertical force per distance of the axle from where it is built, one rope's share", 0.0, 1e8, nominal=1e4, off=0.0
    )


register(JammedGuide)
STIFFNESS = slot("effects.jammed_guide.stiffness")


@kernel
def jam(n, t, p, q, v, w, f):
    """Subtract the guide's force."""
    force = p[STIFFNESS] * (q[n] - p[PIT])
    f[n] -= force
    return -force * v[n]


@kernel
def jam_tangent(n, t, p, q, v, w, A, weights):
    """The guide's stiffness."""
    A[DXX * (n + 1) + n] += weights.ck * p[STIFFNESS]


acts(JammedGuide, forces=jam, tangents=jam_tangent)
