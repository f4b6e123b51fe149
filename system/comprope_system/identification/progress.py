"""Progress of long computations: a callback that is given the name of each stage as it begins."""

from collections.abc import Callable

ProgressCallback = Callable[[str], None]


def no_progress(stage: str) -> None:
    """Report nothing."""
