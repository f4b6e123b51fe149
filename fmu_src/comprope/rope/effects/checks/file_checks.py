"""Checks of a user's file of effects as it is run: imports, quantities, and the arguments of kernels."""

import ast
import types

from ....errors import InputError
from ....kernels import jit
from ....quantities import Quantity, quantities
from ..base import HOOKS, Effect, Kernel


class FileError(Exception):
    """An error with its line number."""

    def __init__(self, text: str, line: int) -> None:
        super().__init__(text)
        self.line = line


def refuse_imports(tree: ast.Module, api: str) -> None:
    """Refuse imports of comprope other than of its module `api`."""
    accepted = f"of comprope, only `from {api} import ...` is accepted, since an FMU has no more"
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            wrong = [node.module or "."] if node.level or (_of_comprope(str(node.module)) and node.module != api) else []
        else:
            wrong = [one.name for one in node.names if _of_comprope(one.name)] if isinstance(node, ast.Import) else []
        for name in wrong:
            raise FileError(f"imports {name}; {accepted}", getattr(node, "lineno", 0))


def _of_comprope(module: str) -> bool:
    return module.partition(".")[0] == "comprope"


def require_declared(made: dict[str, type[Effect]], module: types.ModuleType, tree: ast.Module) -> None:
    """Refuse effects without quantities or hooks, quantities that are none, and hooks that cannot be called."""
    lines = {node.name: node.lineno for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    if not any(effect.hooks for effect in made.values()):
        raise FileError("no effect that acts; register(EFFECT) and acts(EFFECT, ...) are needed, see docs/own_effect.md", 0)
    for effect in made.values():
        _require_quantities(effect, lines.get(effect.__name__, 0))
        for hook, function in effect.hooks.items():
            _require_kernel(hook, function, module, lines)


def _require_quantities(effect: type[Effect], line: int) -> None:
    numbers = {one.name: one for one in quantities(effect)}
    form = "quantity(unit, help, minimum, maximum)"
    if not numbers:
        raise FileError(f"{effect.__name__} has no quantity; `size: float = {form}` is one", line)
    for name in effect.model_fields:
        if name not in numbers:
            raise FileError(f"{effect.__name__}.{name}: not declared by {form}", line)
        if wrong := _quantity_problem(numbers[name]):
            raise FileError(f"{effect.__name__}.{name}: {wrong}", line)


def _quantity_problem(one: Quantity) -> str | None:
    from ....fmi.units import exponents

    try:
        exponents(one.unit)
    except InputError as error:
        return str(error)
    for what, value in (("neutral", one.neutral), ("nominal", one.nominal)):
        if not one.minimum <= value <= one.maximum:
            return f"its {what} value {value:g} is outside of {one.minimum:g} to {one.maximum:g}"
    return None


def _require_kernel(hook: str, function: Kernel, module: types.ModuleType, lines: dict[str, int]) -> None:
    plain = getattr(function, "py_func", function)
    name = getattr(plain, "__name__", str(plain))
    line = lines.get(name, 0)
    if vars(module).get(name) is not function or not isinstance(plain, types.FunctionType):
        raise FileError(f"{hook}={name}: a function of this file is accepted", line)
    if function is plain and not jit.PURE:
        raise FileError(f"{name}: not a kernel; write @kernel above it", line)
    arguments = ", ".join(plain.__code__.co_varnames[: plain.__code__.co_argcount])
    if arguments != HOOKS[hook]:
        unpacked = ", where ck, cc = weights" if hook == "tangents" else ""
        raise FileError(f"{name}({arguments}): for {hook} the arguments ({HOOKS[hook]}) are accepted{unpacked}", line)
