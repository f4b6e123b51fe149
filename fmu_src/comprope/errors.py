"""Exceptions with messages for the user."""


class CompropeError(Exception):
    """Base class of all exceptions that this package raises deliberately."""


class InputError(CompropeError):
    """An invalid value, file or option; the message names the quantity, its value and what is accepted."""


class SimulationError(CompropeError):
    """A simulation failed; the message states the reason, the place and the time."""
