"""How the plant's functions are compiled, and where the compiled code is kept."""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba import config

from comprope.user_cache import entry_folder

OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract", "arcp", "nsz", "reassoc"}}


def _folder() -> str:
    """A folder named after the sources: a cache beside them would not notice that a called function in another file changed."""
    sources = sorted(Path(__file__).parent.glob("*.py"))
    content = hashlib.sha256(b"".join(one.read_bytes() for one in sources)).hexdigest()
    return str(entry_folder("plant", content[:16]))


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
