"""Progress of a long computation: a callback provided by the caller."""

from collections.abc import Callable

Progress = Callable[[str, int, int], None]
"""Called with what is being computed, the number of steps done, and the number of all steps, 0 where it is unknown."""


def no_progress(text: str, done: int = 0, total: int = 0) -> None:
    """Report nothing."""
