"""What a file with an effect of your own imports: `from comprope.effect import Effect, acts, kernel, quantity, register, slot`.

See docs/own_effect.md. In an FMU this package has another name; a file of effects finds these names there all the same.
"""

from .rope.effects.public_names import Effect, acts, kernel, quantity, register, slot, work

__all__ = ["Effect", "acts", "kernel", "quantity", "register", "slot", "work"]
