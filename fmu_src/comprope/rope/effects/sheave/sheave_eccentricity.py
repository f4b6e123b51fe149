"""Eccentricity of the sheave: the centre of the groove's circle rotates about the axle."""

from math import cos, pi, sin

from ....kernels.jit import kernel
from ....quantities import quantity
from ...parameters.parameter_vector import slot
from ..base import Effect, acts, register


class SheaveEccentricity(Effect):
    """Eccentricity (runout) of the groove."""

    name = "sheave_eccentricity"
    proportional = True
    polar = ("eccentricity", "phase")
    eccentricity: float = quantity("m", "distance of the groove's centre from the axle", 0.0, 0.05, nominal=1e-3, off=0.0)
    phase: float = quantity(
        "rad",
        "direction of that distance at the start, from straight down towards the car",
        -2 * pi,
        2 * pi,
        default=0.0,
        nominal=1.0,
    )


register(SheaveEccentricity)
ECCENTRICITY = slot("effects.sheave_eccentricity.eccentricity")
PHASE = slot("effects.sheave_eccentricity.phase")


@kernel
def centre(p, angle):
    """Offset of the groove's centre (down, towards the counterweight) and its derivative by angle.

    The sheave turns its lowest point towards the car while the car goes up.
    """
    e, turned = p[ECCENTRICITY], angle + p[PHASE]
    return e * cos(turned), -e * sin(turned), -e * sin(turned), -e * cos(turned)


acts(SheaveEccentricity, groove=centre)
