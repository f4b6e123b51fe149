"""Source text of generated functions: those that run all effects of a model, and the entry points.

An entry point has C's simplest arguments: a table of arrays, a table of integers, and numbers. It builds the groups of
`runtime.kernel_arguments` from the tables and calls its kernel; which groups, and which numbers, the kernel's
annotations say.
"""

import inspect
from collections.abc import Callable, Iterator
from typing import Any, get_args, get_type_hints

from ..effects.base import HOOKS, Effect
from ..runtime.kernel_arguments import TABLE, Array

NUMBERS = (int, float, bool)


def hook_source(hook: str, effects: list[type[Effect]]) -> str:
    """Source of one function that runs a hook through all effects that have it."""
    having = [
        (k, effect) for k, effect in enumerate(effects) if hook in effect.hooks or (hook == "tangents" and lacks_tangents(effect))
    ]
    calls = [(k, f"{effect.name}_{hook}({HOOKS[hook]})") for k, effect in having]
    if hook == "groove":
        lines = ["x, y, gx, gy = 0.0, 0.0, 0.0, 0.0"]
        for _, call in calls:
            lines += [f"a, b, c, d = {call}", "x, y, gx, gy = x + a, y + b, gx + c, gy + d"]
        return _function(hook, HOOKS[hook], [*lines, "return x, y, gx, gy"])
    powered = hook in ("moments", "forces")
    arguments = HOOKS[hook] + (", power" if powered else "")
    lines = [f"power[{k}] {'=' if hook == 'moments' else '+='} {call}" if powered else call for k, call in calls]
    if hook == "moments":
        lines = [f"power[{k}] = 0.0" for k in range(len(effects))] + lines
    return _function(hook, arguments, lines or ["pass"])


def lacks_tangents(effect: type[Effect]) -> bool:
    """Whether an effect has forces without tangents, which are then found by differences."""
    return "forces" in effect.hooks and "tangents" not in effect.hooks


def _function(name: str, arguments: str, lines: list[str]) -> str:
    body = "\n".join(f"    {line}" for line in lines)
    return f"@kernel\ndef all_{name}({arguments}):\n{body}\n"


# -- entry points ------------------------------------------------------------------------------------


def _own_fields(group: Any) -> list[tuple[str, Any]]:
    hints = get_type_hints(group)
    return [(name, hints[name]) for name in group._fields]


def _fields(group: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    """Names and types of the fields of a group and of the groups in it."""
    for name, kind in _own_fields(group):
        yield from _fields(kind, f"{prefix}.{name}") if hasattr(kind, "_fields") else [(f"{prefix}.{name}", kind)]


def _places(kind: Any) -> dict[str, int]:
    """Index in a table of every field of this kind, by group and name: `State.q`, `Directions.work.D`."""
    found = [name for group in TABLE for name, one in _fields(group, group.__name__) if one == kind]
    return {name: place for place, name in enumerate(found)}


ARRAYS, INTEGERS = _places(Array), _places(int)


def flattened(*groups: Any) -> dict[str, Any]:
    """The fields of groups by name, as in ARRAYS and INTEGERS."""

    def fields(group: Any, prefix: str) -> Iterator[tuple[str, Any]]:
        for name, value in group._asdict().items():
            yield from fields(value, f"{prefix}.{name}") if hasattr(value, "_fields") else [(f"{prefix}.{name}", value)]

    return {name: value for group in groups for name, value in fields(group, type(group).__name__)}


class EntrySource:
    """Source of one entry point of a kernel; groups among `absent` are None, so that code that needs them is left out.

    `scalars` are the types of its numbers by name, `used` the arrays and integers that it takes from the tables.
    """

    def __init__(self, name: str, kernel: Callable[..., Any], absent: tuple[Any, ...] = ()) -> None:
        self.name = name
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
        if path not in ARRAYS and path not in INTEGERS:
            self.scalars[path.rpartition(".")[2]] = kind
            return path.rpartition(".")[2]
        self.used.append(path)
        return f"arrays[{ARRAYS[path]}]" if path in ARRAYS else f"integers[{INTEGERS[path]}]"
