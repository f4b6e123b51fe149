"""Kernels of many modules in one namespace, in which they call each other and the effects of a model."""

import types
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from . import jit
from .inlining import inlined_kernel


def merged(modules: Iterable[types.ModuleType], replacing: Mapping[str, Any]) -> dict[str, Any]:
    """The names of all modules together, with what takes the place of the hooks among them.

    Raises `ValueError` where one name stands for different things in two modules: one would silently take the other's place.
    """
    names, origin = dict(replacing), dict.fromkeys(replacing, "")
    for module in modules:
        for name, value in vars(module).items():
            if name.startswith("__") or name in replacing:
                continue
            if name in names and names[name] is not value:
                raise ValueError(f"{name} is defined in {origin[name]} and otherwise in {module.__name__}: rename one of them")
            names[name] = value
            origin.setdefault(name, module.__name__)
    return names


def linked(names: Mapping[str, Any], module: str, compile: Callable[..., Any] = inlined_kernel) -> dict[str, Any]:
    """A copy of a namespace in which every kernel calls the kernels of that copy."""
    copy = {key: value for key, value in names.items() if not key.startswith("__")} | {"__name__": module}
    for key, value in names.items():
        function = getattr(value, "py_func", value)
        compilable = value is not function or (jit.PURE and isinstance(function, types.FunctionType))
        if compilable and function.__module__ not in (jit.__name__, module):
            copy[key] = compile(types.FunctionType(function.__code__, copy, function.__name__))
    return copy


def uncompiled(*modules: types.ModuleType) -> types.SimpleNamespace:
    """The kernels of modules as plain functions of Python, which also take lists: for few calls, without a compiler."""
    return types.SimpleNamespace(**linked(merged(modules, {}), "comprope_uncompiled", compile=lambda function: function))
