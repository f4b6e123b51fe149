"""Consent to run code that a user's files name: given for a command by an option, or by an environment variable."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

VARIABLE = "COMPROPE_ALLOW_CODE"


def given() -> bool:
    """Whether there is consent."""
    return os.environ.get(VARIABLE) == "1"


@contextmanager
def giving(allow: bool = True) -> Iterator[None]:
    """Consent while the context lasts, if `allow`; in the environment, so that processes started meanwhile have it too."""
    before = os.environ.get(VARIABLE, "")
    os.environ[VARIABLE] = "1" if allow else before
    try:
        yield
    finally:
        os.environ[VARIABLE] = before
