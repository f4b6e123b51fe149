"""Compilation of kernels that only other kernels call: once, within the entry points that inline them.

numba optimises every function and makes machine code of it, again and again for each one that calls it. An entry point
needs neither: its own optimisation sees the code of all that it calls. This leaves out three fifths of the time that
kernels take to compile, and the entry points compute the same bits.
"""

import ctypes
from collections.abc import Callable
from typing import Any

import numba
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler

from .jit import OPTIONS, PURE

_REFUSAL = ctypes.cast(ctypes.pythonapi.PyErr_BadArgument, ctypes.c_void_p).value or 0


class _NoMachineCode:
    """Stands for the code generator where numba tells a function the address of its globals: there is no function."""

    def set_env(self, name: str, environment: Any) -> None:
        """Do nothing."""


class _CodeToInline(JITCodeLibrary):
    """The code of one kernel as lowered, to be linked into the library of an entry point."""

    codegen = _NoMachineCode()

    def _optimize_final_module(self) -> None:
        """Leave it to the entry point."""

    def _finalize_final_module(self) -> None:
        """Make no machine code."""
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """The address of what Python calls instead of machine code, which raises `TypeError`."""
        return _REFUSAL


class _InlinedCompiler(Compiler):
    """numba's compiler with such a library for its result."""

    def compile_extra(self, func: Callable[..., Any]) -> Any:
        self.state.library = _CodeToInline(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


def inlined_kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """A kernel that compiled functions can call; Python that calls it gets a `TypeError`."""
    if PURE:
        return function
    options: dict[str, Any] = {"pipeline_class": _InlinedCompiler, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return numba.njit(function, **OPTIONS, **options)
