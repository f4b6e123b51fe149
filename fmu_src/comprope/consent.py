"""Consent of the user to execute Python files named in a model file, and to read files outside of a campaign's folder.

Each is given by an option or an environment variable.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager

VARIABLE = "COMPROPE_ALLOW_CODE"
OUTSIDE = "COMPROPE_ALLOW_OUTSIDE"


def given() -> bool:
    """Whether consent to execute files has been given."""
    return os.environ.get(VARIABLE) == "1"


def outside_given() -> bool:
    """Whether consent to read files outside of a campaign's folder has been given."""
    return os.environ.get(OUTSIDE) == "1"


@contextmanager
def giving(allow: bool = True, variable: str = VARIABLE) -> Iterator[None]:
    """Consent within the context if `allow`; set in the environment, so that child processes inherit it."""
    before = os.environ.get(variable, "")
    os.environ[variable] = "1" if allow else before
    try:
        yield
    finally:
        os.environ[variable] = before
