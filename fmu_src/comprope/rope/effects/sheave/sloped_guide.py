"""Sloped guide of the sheave: the axle moves sideways as it rises and falls.

y_s = slope (x_s - pit), towards the counterweight's side when it sinks, from where it is built (geometry of an inclined rail).
What presses the sheave sideways then moves it up or down too, by the slope's share. Left out is the sheave's sideways inertia.
"""

from ....kernels.jit import kernel
from ....quantities import quantity
from ...parameters.parameter_vector import PIT, slot
from ..base import Effect, acts, register


class SlopedGuide(Effect):
    """Inclined guide rails of the sheave."""

    name = "sloped_guide"
    proportional = True
    slope: float = quantity(
        "1", "motion of the axle towards the counterweight's side over its motion down", -5.0, 5.0, nominal=0.1, off=0.0
    )


register(SlopedGuide)
SLOPE = slot("effects.sloped_guide.slope")


@kernel
def incline(p, depth):
    """Offset of the axle and its derivative by depth."""
    return p[SLOPE] * (depth - p[PIT]), p[SLOPE]


acts(SlopedGuide, rail=incline)
