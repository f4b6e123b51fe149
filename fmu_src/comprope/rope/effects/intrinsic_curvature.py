"""Intrinsic curvature of the rope, at which its bending moment is zero: M = EI (kappa - kappa_0)."""

from ...kernels.jit import kernel
from ...quantities import quantity
from ..parameters.parameter_vector import EI, ELEMENT, slot
from ..runtime.array_layout import BEND_RATE, MOMENT
from .base import Effect, acts, register


class IntrinsicCurvature(Effect):
    """Curvature of the rope without load, from storage on a drum."""

    name = "intrinsic_curvature"
    proportional = True
    curvature: float = quantity("1/m", "curvature without moment, positive as on the sheave", -5.0, 5.0, nominal=0.1, off=0.0)


register(IntrinsicCurvature)
KAPPA = slot("effects.intrinsic_curvature.curvature")


@kernel
def own_moment(n, p, w, h0, h1):
    """Take EI kappa_0 off the moment of every inner node."""
    if p[KAPPA] == 0.0:
        return 0.0
    m, own, power = n + 1, p[EI] * p[KAPPA], 0.0
    for i in range(1, n - 1):
        w[MOMENT * m + i] -= own
        power += own * w[BEND_RATE * m + i] * p[ELEMENT]
    return power


acts(IntrinsicCurvature, moments=own_moment)
