"""Changed values of a model: a mapping from keys to values, or texts KEY=VALUE as the command line has them."""

import tomllib
from collections.abc import Mapping, Sequence
from typing import Any

from comprope.errors import InputError

Changes = Mapping[str, Any] | Sequence[str]


def assignments(texts: Sequence[str], option: str = "--set") -> dict[str, Any]:
    """`["sheave.mass=90"]`, stated by an option, as `{"sheave.mass": 90}`; values are written as in a model file."""
    found = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise InputError(f"{option} {text}: KEY=VALUE is accepted, such as sheave.mass=90")
        try:
            found[key.strip()] = tomllib.loads(f"value = {value}")["value"]
        except tomllib.TOMLDecodeError:
            found[key.strip()] = value.strip()
    return found


def by_key(changes: Changes | None, option: str = "--set", argument: str = "changes") -> tuple[dict[str, Any], str]:
    """Changed values by their keys, and what an error message calls the place that they come from."""
    if changes is None or isinstance(changes, Mapping):
        return dict(changes or {}), argument
    return assignments(changes, option), option
