"""Scale of the encoder: the car goes another way than its position signal says, and the counterweight goes the same way back.

A signal that reads (1 + excess) times the true height, as from an encoder's wheel that is worn or of another diameter, puts
the car at x / (1 + excess), with velocity and acceleration in the same proportion; heights count from the bottom landing. The
counterweight moves by as much the other way, since the hoist ropes join both.
"""

from ...kernels.jit import kernel
from ...quantities import quantity
from ..parameters.parameter_vector import slot
from .base import Effect, acts, register


class EncoderScale(Effect):
    """Wrong scale of the signal of the car's position."""

    name = "encoder_scale"
    excess: float = quantity(
        "1", "what the signal of the car's position shows beyond the true height, over it", -0.5, 0.5, nominal=1e-3, off=0.0
    )


register(EncoderScale)
EXCESS = slot("effects.encoder_scale.excess")


@kernel
def rescale(n, t, p, q, v, a):
    """Move both ends to where the car truly is."""
    if p[EXCESS] == 0.0:
        return
    less = p[EXCESS] / (1.0 + p[EXCESS])
    q[n - 1] += less * q[0]
    v[n - 1] += less * v[0]
    a[n - 1] += less * a[0]
    q[0] -= less * q[0]
    v[0] -= less * v[0]
    a[0] -= less * a[0]


acts(EncoderScale, ends=rescale)
