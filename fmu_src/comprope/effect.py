"""What a file with an effect of your own imports: `from comprope.effect import Effect, acts, kernel, quantity, register, slot`.

See docs/own_effect.md. In an FMU this package has another name; a file of effects finds these names there all the same.
"""

from .quantities import quantity
from .rope.effects.base import Effect, acts, register
from .rope.runtime import array_layout as work
from .rope.runtime.jit import kernel
from .rope.runtime.parameter_vector import slot

__all__ = ["Effect", "acts", "kernel", "quantity", "register", "slot", "work"]
