"""How every kernel is compiled: no bounds checks, division as in C, and no reordering of sums,
so that the same source gives the same bits just in time and ahead of time.

Array arguments are only indexed and nothing is allocated inside; `COMPROPE_PURE_PYTHON=1` runs
the kernels without a compiler, for coverage and for debugging.
"""

import os
from collections.abc import Callable
from typing import Any

import numba

OPTIONS: dict[str, Any] = {"error_model": "numpy", "boundscheck": False, "nogil": True}
PURE = os.environ.get("COMPROPE_PURE_PYTHON") == "1"


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a kernel; callers inline it as the compiler sees fit."""
    if PURE:
        return function
    return numba.njit(function, **OPTIONS)  # type: ignore[no-any-return]


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function that Python calls, and keep the result on disk beside its source."""
    if PURE:
        return function
    return numba.njit(function, cache=True, **OPTIONS)  # type: ignore[no-any-return]
