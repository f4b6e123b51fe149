"""Lateral displacement of the rope's ends: building sway and attachment offsets.

Inside, +y points from the car's side to the counterweight's; the attachment offsets are outward.
"""

from math import cos, pi, sin

from ...kernels.jit import kernel
from ...quantities import quantity
from ..parameters.parameter_vector import HEIGHT, PIT, slot
from .base import Effect, acts, register


class BuildingSway(Effect):
    """Harmonic sway of the building, growing linearly from the pit to the top landing."""

    name = "building_sway"
    proportional = True
    polar = ("amplitude", "phase")
    amplitude: float = quantity(
        "m", "amplitude at the top landing, towards the counterweight's side", 0.0, 5.0, nominal=0.05, off=0.0
    )
    frequency: float = quantity("Hz", "frequency", 0.001, 20.0, nominal=0.2, off=0.2)
    phase: float = quantity("rad", "phase at time zero, of a sine", -2 * pi, 2 * pi, default=0.0, nominal=1.0)


class AttachmentOffset(Effect):
    """Lateral offsets of the rope's ends relative to the sides of the sheave."""

    name = "attachment_offset"
    proportional = True
    car: float = quantity("m", "outward offset of the end under the car", -0.5, 0.5, default=0.0, nominal=0.01)
    counterweight: float = quantity(
        "m", "outward offset of the end under the counterweight", -0.5, 0.5, default=0.0, nominal=0.01
    )


register(BuildingSway)
register(AttachmentOffset)
AMPLITUDE = slot("effects.building_sway.amplitude")
FREQUENCY = slot("effects.building_sway.frequency")
PHASE = slot("effects.building_sway.phase")
CAR = slot("effects.attachment_offset.car")
COUNTERWEIGHT = slot("effects.attachment_offset.counterweight")


@kernel
def sway(n, t, p, q, v, a):
    """Add the building's motion at the height of each end; an end's own travel changes its share."""
    if p[AMPLITUDE] == 0.0:
        return
    m, rate = n + 1, 2.0 * pi * p[FREQUENCY]
    per_metre = p[AMPLITUDE] / (p[HEIGHT] + p[PIT])
    s, c = sin(rate * t + p[PHASE]), cos(rate * t + p[PHASE])
    for i in (0, n - 1):
        share, share_v, share_a = (p[PIT] - q[i]) * per_metre, -v[i] * per_metre, -a[i] * per_metre
        q[m + i] += share * s
        v[m + i] += share_v * s + share * rate * c
        a[m + i] += share_a * s + 2.0 * share_v * rate * c - share * rate * rate * s


@kernel
def offset(n, t, p, q, v, a):
    """Move each end outward by its offset."""
    q[n + 1] -= p[CAR]
    q[2 * n] += p[COUNTERWEIGHT]


acts(BuildingSway, ends=sway)
acts(AttachmentOffset, ends=offset)
