"""How every kernel is compiled: no bounds checks, division as in C, and no reordering of sums,
so that the same source gives the same bits just in time and ahead of time.

Array arguments are only indexed and nothing is allocated inside; `COMPROPE_PURE_PYTHON=1` runs
the kernels without a compiler, for coverage and for debugging.
"""

import os
from collections.abc import Callable
from typing import Any

import numba
import numba.extending
import numpy as np

OPTIONS: dict[str, Any] = {"error_model": "numpy", "boundscheck": False, "nogil": True}
PURE = os.environ.get("COMPROPE_PURE_PYTHON") == "1"
POINTER = numba.types.CPointer(numba.float64)


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a kernel; callers inline it as the compiler sees fit."""
    if PURE:
        return function
    return numba.njit(function, **OPTIONS)


@numba.extending.intrinsic
def _stack_array(context, size):
    """Memory for `size` numbers that a kernel has until it returns, taken from the stack."""

    def code(context, builder, signature, arguments):
        return builder.alloca(context.get_value_type(numba.float64), size=arguments[0])

    return POINTER(numba.int64), code


stack_array: Callable[..., Any] = np.zeros if PURE else _stack_array
