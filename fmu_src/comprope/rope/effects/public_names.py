"""The names that a file with a user's effect may import from `comprope.effect`."""

from ...kernels.jit import kernel
from ...quantities import quantity
from ..parameters.parameter_vector import slot
from ..runtime import array_layout as work
from .base import Effect, acts, register

__all__ = ["Effect", "acts", "kernel", "quantity", "register", "slot", "work"]
