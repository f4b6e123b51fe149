"""Consent of the user to execute Python files named in a model file: by an option or an environment variable."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

VARIABLE = "COMPROPE_ALLOW_CODE"


def given() -> bool:
    """Whether consent has been given."""
    return os.environ.get(VARIABLE) == "1"


@contextmanager
def giving(allow: bool = True) -> Iterator[None]:
    """Consent within the context if `allow`; set in the environment, so that child processes inherit it."""
    before = os.environ.get(VARIABLE, "")
    os.environ[VARIABLE] = "1" if allow else before
    try:
        yield
    finally:
        os.environ[VARIABLE] = before
