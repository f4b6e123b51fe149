"""The part of `reference.md` about the Python interface: functions with arguments, options, and results with their fields."""

import inspect
import re
from collections.abc import Callable, Iterable
from dataclasses import MISSING, fields, is_dataclass
from typing import Any

import comprope_system
from comprope_system.report.result import Result

INTRODUCTION = """## Python interface

`import comprope_system` gives scripts and notebooks the functions below. Each returns one result object with its own fields, and
with `summary()`, `to_json()`, `to_dataframe()`, `save_html(path)` and `save_json(path)`; in a notebook it shows a short table.
The functions print nothing and write nothing except a `checkpoint` that is asked for. With `jobs` above 1, a script calls them
under `if __name__ == "__main__":`, because the processes import it.

`progress` is a function `progress(text, done, total)`, called with what is being computed, the number of steps done and that of
all steps, 0 where it is unknown. `executor` is any executor of `concurrent.futures`, or the address of a Dask scheduler.

In JSON, `misfit_per_datum`, `chi_square_per_sample`, `clues`, `bought` and `pruned` are older names of `reduced_chi_square`,
`residual_correlations`, `error_reductions` and `removed`; both are written in this version.
"""
NAMES = (
    "simulate", "modes", "new", "check", "compare", "diagnose", "add", "improve", "tune", "design", "building", "sway", "fmu",
)  # fmt: skip
OPTIONS = ("CarMotion", "Stop", "TuningOptions", "DesignOptions", "BuildingSway", "RopeSet", "RecordOptions", "SwayOptions")


def text(table: Callable[[Iterable[str], Iterable[Iterable[str]]], str]) -> str:
    """The chapter; `table` makes a table of Markdown from a head and rows."""
    functions = [getattr(comprope_system, name) for name in NAMES]
    results = [inspect.signature(one).return_annotation for one in functions]
    parts = [INTRODUCTION, *(_function(one, table) for one in functions)]
    parts += [_class(getattr(comprope_system, name), table) for name in OPTIONS]
    parts += [_common(table), *(_class(one, table) for one in results)]
    return "\n".join(parts)


def _function(function: Callable[..., Any], table: Callable[..., str]) -> str:
    signature = inspect.signature(function)
    rows = [(f"`{one.name}`", _type(one.annotation), _default(one.default)) for one in signature.parameters.values()]
    result = signature.return_annotation.__name__
    title = f"### `{function.__name__}(...)`\n\nReturns [`{result}`](#{result.lower()}).\n"
    return f"{title}\n{_prose(function)}\n\n{table(('argument', 'type', 'default'), rows)}"


def _class(kind: type, table: Callable[..., str]) -> str:
    """An options or a result class: its fields, then its properties and methods that not every result has."""
    rows = []
    if is_dataclass(kind):
        for one in fields(kind):
            default = "" if one.default is MISSING else _default(one.default)
            rows.append((f"`{one.name}`", _type(one.type), default, ""))
    shared = {name for name in dir(Result) if not name.startswith("_")}
    members = [name for name in _members(kind) if name not in {one.name for one in fields(kind)} and name not in shared]
    for name in members:
        member = inspect.getattr_static(kind, name)
        if isinstance(member, property):
            rows.append((f"`{name}`", _type(inspect.signature(member.fget).return_annotation), "", _first_line(member)))
        else:
            rows.append((_call(member), "", "", _first_line(member)))
    return f"### `{kind.__name__}`\n\n{_prose(kind)}\n\n{table(('field', 'type', 'default', ''), rows)}"


def _members(kind: type) -> list[str]:
    """Public properties and methods, in the order in which they are defined."""
    found: dict[str, None] = {}
    for base in kind.__mro__[:-1]:
        found |= {
            name: None
            for name, member in vars(base).items()
            if not name.startswith("_") and (isinstance(member, property) or inspect.isfunction(member))
        }
    return list(found)


def _common(table: Callable[..., str]) -> str:
    rows = [(_call(getattr(Result, name)), _first_line(getattr(Result, name))) for name in _members(Result)]
    return f"### Every result\n\n{table(('method', ''), rows)}"


def _call(method: Callable[..., Any]) -> str:
    """A method with the names of its arguments."""
    return f"`{method.__name__}({', '.join(list(inspect.signature(method).parameters)[1:])})`"


def _prose(documented: Any) -> str:
    return inspect.cleandoc(documented.__doc__ or "")


def _first_line(documented: Any) -> str:
    return _prose(documented).split("\n\n")[0].replace("\n", " ")


def _type(annotation: Any) -> str:
    """An annotation as a reader writes it: without modules."""
    written = annotation.__name__ if isinstance(annotation, type) and not hasattr(annotation, "__args__") else str(annotation)
    written = re.sub(r"[A-Za-z_]+[.](?=[A-Za-z_])", "", written)
    return "`ndarray`" if written.startswith("ndarray") else f"`{written}`"


def _default(value: Any) -> str:
    if value is inspect.Parameter.empty:
        return "required"
    return f"`{getattr(value, '__name__', value)!s}`" if callable(value) else f"`{value!r}`"
