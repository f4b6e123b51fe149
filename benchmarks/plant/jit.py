"""How the plant's functions are compiled, and where the compiled code is kept."""

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba import config

OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract", "arcp", "nsz", "reassoc"}}


def _folder() -> str:
    """A folder named after the sources: a cache beside them would not notice that a called function in another file changed.

    It is in the user's own cache folder: compiled code is loaded from there, so that no other user may write to it.
    """
    sources = sorted(Path(__file__).parent.glob("*.py"))
    content = hashlib.sha256(b"".join(one.read_bytes() for one in sources)).hexdigest()
    own = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return str(own / "comprope" / f"plant_{content[:16]}")


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function that other compiled functions call."""
    return numba.njit(function, **OPTIONS)


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function that Python calls, and keep it for other processes."""
    before, config.CACHE_DIR = config.CACHE_DIR, _folder()
    try:
        return numba.njit(function, cache=True, **OPTIONS)
    finally:
        config.CACHE_DIR = before
