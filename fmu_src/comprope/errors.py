"""What can go wrong, in words a user can act on."""


class CompropeError(Exception):
    """Base of every error this package raises on purpose."""


class InputError(CompropeError):
    """A user's value, file or option is not acceptable; the text names quantity, value and what is accepted."""


class SimulationError(CompropeError):
    """A step could not be saved by halving it; the text says what, where and when."""
