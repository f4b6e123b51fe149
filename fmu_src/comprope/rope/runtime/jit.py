"""How every kernel is compiled: no bounds checks, division as in C, and no reordering of sums,
so that the same source gives the same bits just in time and ahead of time.

Array arguments are only indexed and nothing is allocated inside; `COMPROPE_PURE_PYTHON=1` runs
the kernels without a compiler, for coverage and for debugging.
"""

import ctypes
import inspect
import os
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import cached_property
from typing import Any, ClassVar

import numba
import numba.extending
import numpy as np
from numpy.typing import NDArray

OPTIONS: dict[str, Any] = {"error_model": "numpy", "boundscheck": False, "nogil": True}
PURE = os.environ.get("COMPROPE_PURE_PYTHON") == "1"


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a kernel; callers inline it as the compiler sees fit."""
    if PURE:
        return function
    return numba.njit(function, **OPTIONS)


@numba.extending.intrinsic
def _room(context, size):
    """Memory for `size` numbers that a kernel has until it returns, taken from the stack."""
    pointer = numba.types.CPointer(numba.float64)

    def code(context, builder, signature, arguments):
        return builder.alloca(context.get_value_type(numba.float64), size=arguments[0])

    return pointer(numba.int64), code


room: Callable[..., Any] = np.zeros if PURE else _room


INTEGERS = {"n", "m", "steps", "state_size", "effects", "side", "directions", "blocks", "parameters", "sensors"}
FLAGS = {"tangent", "exact"}
NUMBERS = {"t", "t0", "dt", "s", "ck", "cc", "x", "element"}


def kind(name: str) -> str:
    """What an argument of a kernel is, by its name: "integer", "flag", "number" or "array"."""
    return "integer" if name in INTEGERS else "flag" if name in FLAGS else "number" if name in NUMBERS else "array"


class Entry:
    """A kernel that Python calls: compiled for pointers, kept on disk beside its source, called through C.

    Pointers spare the checks for negative indices, which keep the compiler from using vector units.
    """

    _TYPES: ClassVar[dict[str, Any]] = {
        "integer": numba.int64,
        "flag": numba.boolean,
        "number": numba.float64,
        "array": numba.types.CPointer(numba.float64),
    }

    def __init__(
        self, function: Callable[..., Any], returns: str, compiling: Callable[[], AbstractContextManager[None]] = nullcontext
    ) -> None:
        self.function, self._compiling = function, compiling
        self.names = tuple(inspect.signature(function).parameters)
        result = numba.void if returns == "nothing" else self._TYPES[returns]
        self.signature = result(*(self._TYPES[kind(name)] for name in self.names))

    @cached_property
    def compiled(self) -> Callable[..., Any]:
        """The function to call: compiled, or as it is where there is no compiler."""
        if PURE:
            return self.function
        options = {key: value for key, value in OPTIONS.items() if key != "nogil"}
        with self._compiling():
            return numba.cfunc(self.signature, cache=True, **options)(self.function).ctypes

    def bind(self, **arrays: NDArray[np.float64]) -> Callable[..., Any]:
        """The function with its arrays filled in; what is left to give, by name, are the scalars.

        The arrays must be contiguous and outlive the function.
        """
        filled = {name: array if PURE else ctypes.cast(array.ctypes.data, self._POINTER) for name, array in arrays.items()}
        template: list[Any] = [filled.get(name) for name in self.names]
        places = {name: k for k, name in enumerate(self.names) if name not in arrays}
        call = self.compiled

        def bound(**scalars: float) -> Any:
            arguments = template.copy()
            for name, value in scalars.items():
                arguments[places[name]] = value
            return call(*arguments)

        bound.keep = arrays  # type: ignore[attr-defined]
        return bound

    _POINTER = ctypes.POINTER(ctypes.c_double)
