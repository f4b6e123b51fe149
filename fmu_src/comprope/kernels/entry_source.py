"""Source text of entry points: functions that Python and C call, with C's simplest arguments.

These are a table of arrays, a table of integers, and numbers. An entry point builds the groups that its kernel takes from the
tables and calls the kernel; which groups, and which numbers, the kernel's annotations say.
"""

import inspect
from collections.abc import Callable, Iterator
from typing import Any, get_args, get_type_hints

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NUMBERS = (int, float, bool)


def _own_fields(group: Any) -> list[tuple[str, Any]]:
    hints = get_type_hints(group)
    return [(name, hints[name]) for name in group._fields]


def _fields(group: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    """Names and types of the fields of a group and of the groups in it."""
    for name, kind in _own_fields(group):
        yield from _fields(kind, f"{prefix}.{name}") if hasattr(kind, "_fields") else [(f"{prefix}.{name}", kind)]


class Tables:
    """Where entry points find the fields of some groups: `arrays` and `integers` have the index in the table by group and name.

    Names are as in `State.q` and, for a group within a group, `Directions.work.D`.
    """

    def __init__(self, groups: tuple[Any, ...]) -> None:
        self.arrays, self.integers = self._places(groups, Array), self._places(groups, int)

    @staticmethod
    def _places(groups: tuple[Any, ...], kind: Any) -> dict[str, int]:
        found = [name for group in groups for name, one in _fields(group, group.__name__) if one == kind]
        return {name: place for place, name in enumerate(found)}


def flattened(*groups: Any) -> dict[str, Any]:
    """The fields of groups by name, as in `Tables`."""

    def fields(group: Any, prefix: str) -> Iterator[tuple[str, Any]]:
        for name, value in group._asdict().items():
            yield from fields(value, f"{prefix}.{name}") if hasattr(value, "_fields") else [(f"{prefix}.{name}", value)]

    return {name: value for group in groups for name, value in fields(group, type(group).__name__)}


class EntrySource:
    """Source of one entry point of a kernel; groups among `absent` are None, so that code that needs them is left out.

    `scalars` are the types of its numbers by name, `used` the arrays and integers that it takes from the tables.
    """

    def __init__(self, name: str, kernel: Callable[..., Any], tables: Tables, absent: tuple[Any, ...] = ()) -> None:
        self.name, self.tables = name, tables
        hints = get_type_hints(getattr(kernel, "py_func", kernel))
        self.result: Any = hints.pop("return")
        self.scalars: dict[str, Any] = {}
        self.used: list[str] = []
        arguments = ", ".join(self._argument(key, kind, absent) for key, kind in hints.items())
        parameters = ", ".join(["arrays", "integers", *self.scalars])
        call = f"{kernel.__name__}({arguments})"
        self.text = f"def call_{name}({parameters}):\n    {call if self.result is type(None) else f'return {call}'}\n"

    def _argument(self, name: str, kind: Any, absent: tuple[Any, ...]) -> str:
        if kind in NUMBERS:
            self.scalars[name] = kind
            return name
        optional = [one for one in get_args(kind) if one is not type(None)] if not inspect.isclass(kind) else []
        group = optional[0] if optional else kind
        return "None" if group in absent else self._group(group, group.__name__)

    def _group(self, group: Any, prefix: str) -> str:
        return f"{group.__name__}({', '.join(self._field(f'{prefix}.{name}', kind) for name, kind in _own_fields(group))})"

    def _field(self, path: str, kind: Any) -> str:
        if hasattr(kind, "_fields"):
            return self._group(kind, path)
        arrays, integers = self.tables.arrays, self.tables.integers
        if path not in arrays and path not in integers:
            self.scalars[path.rpartition(".")[2]] = kind
            return path.rpartition(".")[2]
        self.used.append(path)
        return f"arrays[{arrays[path]}]" if path in arrays else f"integers[{integers[path]}]"
