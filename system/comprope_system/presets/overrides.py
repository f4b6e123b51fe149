"""Values given on the command line as KEY=VALUE."""

import tomllib
from collections.abc import Sequence
from typing import Any

from comprope.errors import InputError


def assignments(texts: Sequence[str]) -> dict[str, Any]:
    """`["sheave.mass=90"]` as `{"sheave.mass": 90}`; values are written as in a model file."""
    found = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise InputError(f"--set {text}: KEY=VALUE is accepted, such as sheave.mass=90")
        try:
            found[key.strip()] = tomllib.loads(f"value = {value}")["value"]
        except tomllib.TOMLDecodeError:
            found[key.strip()] = value.strip()
    return found
