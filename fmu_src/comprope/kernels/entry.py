"""One entry point: compiled for addresses of arrays, kept on disk, called through C."""

import ctypes
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import cached_property
from typing import Any

import numba

from . import jit
from .entry_source import EntrySource, flattened

_TYPES = {int: numba.int64, float: numba.float64, bool: numba.boolean, type(None): numba.void}
_TABLES = (numba.types.CPointer(jit.POINTER), numba.types.CPointer(numba.int64))


class Entry:
    """A function that Python calls with numbers, once its tables of arrays and integers are bound.

    Addresses spare the checks for negative indices, which keep the compiler from using vector units.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        source: EntrySource,
        compiling: Callable[[], AbstractContextManager[None]] = nullcontext,
    ) -> None:
        self.function, self.source, self._compiling = function, source, compiling
        scalars = (_TYPES[kind] for kind in source.scalars.values())
        self.signature = _TYPES[source.result](*_TABLES, *scalars)

    @cached_property
    def compiled(self) -> Callable[..., Any]:
        """The function to call: compiled, or as it is where there is no compiler."""
        if jit.PURE:
            return self.function
        options = {key: value for key, value in jit.OPTIONS.items() if key != "nogil"}
        with self._compiling():
            return numba.cfunc(self.signature, cache=True, **options)(self.function).ctypes

    def bind(self, *groups: Any) -> Callable[..., Any]:
        """The function with arrays and integers taken from groups; what is left to give are the numbers.

        The arrays must be contiguous and outlive the function.
        """
        fields = flattened(*groups)
        arrays, integers = self._arrays(fields), self._integers(fields)
        call, names = self.compiled, tuple(self.source.scalars)

        def bound(**numbers: float) -> Any:
            return call(arrays, integers, *(numbers[name] for name in names))

        bound.keep = fields  # type: ignore[attr-defined]
        return bound

    def _arrays(self, fields: dict[str, Any]) -> Any:
        """The table of arrays: those that the function uses, in their places."""
        places = self.source.tables.arrays
        used = {places[name]: fields[name] for name in self.source.used if name in places}
        if jit.PURE:
            return used
        pointer = ctypes.POINTER(ctypes.c_double)
        table = (pointer * len(places))()
        for place, array in used.items():
            table[place] = array.ctypes.data_as(pointer)
        return table

    def _integers(self, fields: dict[str, Any]) -> Any:
        """The table of integers, likewise."""
        places = self.source.tables.integers
        used = {places[name]: fields[name] for name in self.source.used if name in places}
        if jit.PURE:
            return used
        return (ctypes.c_int64 * len(places))(*(used.get(place, 0) for place in range(len(places))))
