"""The names that a file with a user's effect may import from `comprope.effect`."""

from ...quantities import quantity
from ..runtime import array_layout as work
from ..runtime.jit import kernel
from ..runtime.parameter_vector import slot
from .base import Effect, acts, register

__all__ = ["Effect", "acts", "kernel", "quantity", "register", "slot", "work"]
