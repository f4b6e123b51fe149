"""User-defined effects: Python files named in a model file, executed once per process and only with consent.

A file is identified by its content, so that copies are the same file. Its effects remain registered, but only
models that name the file have them. A file that fails registers nothing.
"""

import ast
import hashlib
import sys
import threading
import types
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ... import consent
from ...atomic_files import read_text_file
from ...errors import CompropeError, InputError
from ...quantities import Quantity, quantities
from ..runtime import jit
from ..runtime.parameter_vector import DECLARED
from .base import HOOKS, REGISTRY, Effect, Kernel

API = "comprope.effect"  # the module such a file imports; see `_names_at_hand`


@dataclass(frozen=True)
class OwnFile:
    """An executed file: its source and the names of its effects."""

    text: str
    effects: tuple[str, ...]


FILES: dict[str, OwnFile] = {}  # by absolute path
_LOCK = threading.RLock()


def read(path: Path, *, allow_code: bool = False) -> None:
    """Run the file at an absolute path, unless a file of this content has been run.

    Raises `InputError` without consent, which is `allow_code` or the environment variable of `consent`, and for a file that
    cannot be read, fails, or has changed since it was run.
    """
    text = read_text_file(path)
    if _same(text) is None and not (allow_code or consent.given()):
        allow = f"comprope --allow-code ..., build_fmu.py --allow-code, or {consent.VARIABLE}=1"
        raise InputError(f"{path} would be executed as a program; inspect it, then allow it: {allow}")
    admit(str(path), text)


def admit(path: str, text: str) -> None:
    """Execute the source of the file `path`, unless it has been executed before."""
    with _LOCK:
        if path in FILES and FILES[path].text != text:
            raise InputError(f"{path}: has changed since it was run; start the program again")
        FILES[path] = _same(text) or OwnFile(text, _run(path, text))


@contextmanager
def lent(path: str, text: str) -> Iterator[None]:
    """Context in which an internal effect is registered temporarily."""
    kept: list[tuple[Any, dict[str, Any]]] = [(table, dict(table)) for table in (REGISTRY, DECLARED, FILES)]
    admit(path, text)
    try:
        yield
    finally:
        for table, before in kept:
            table.clear()
            table.update(before)


def _same(text: str) -> OwnFile | None:
    return next((one for one in FILES.values() if one.text == text), None)


def _run(path: str, text: str) -> tuple[str, ...]:
    """Register the effects in a source and return their names; raises `InputError` with the line at fault."""
    effects, declared = dict(REGISTRY), dict(DECLARED)
    # Its own name in every copy of this package, since an FMU's copy may live in the same process.
    name = f"{__name__.partition('.')[0]}_own_{Path(path).stem}_{hashlib.sha256(text.encode()).hexdigest()[:8]}"
    module = types.ModuleType(name)
    module.__file__ = path
    sys.modules[name] = module
    try:
        tree = ast.parse(text, path)
        _refuse_imports(tree)
        with _names_at_hand():
            exec(compile(tree, path, "exec"), module.__dict__)
        made = {key: one for key, one in REGISTRY.items() if key not in effects}
        _require_declared(made, module, tree)
    except (Exception, SystemExit) as error:  # a user's code may raise anything
        for table, before in ((REGISTRY, effects), (DECLARED, declared)):
            table.clear()
            table.update(before)  # type: ignore[arg-type]
        del sys.modules[name]
        raise InputError(_sentence(path, error)) from None
    for effect in made.values():
        effect.source = path
    return tuple(made)


@contextmanager
def _names_at_hand() -> Iterator[None]:
    """While a file runs, API means the module of this package, whatever this package is called: in an FMU it has another name."""
    from ... import effect

    kept = sys.modules.get(API)
    sys.modules[API] = effect
    try:
        yield
    finally:
        if kept is None:
            del sys.modules[API]
        else:
            sys.modules[API] = kept


class _WrongError(Exception):
    """An error with its line number."""

    def __init__(self, text: str, line: int) -> None:
        super().__init__(text)
        self.line = line


def _sentence(path: str, error: BaseException) -> str:
    """One sentence with file and line for any exception raised by a file."""
    line = getattr(error, "line", None) or getattr(error, "lineno", None)
    trace = error.__traceback__
    while trace is not None and not isinstance(error, _WrongError | SyntaxError):
        line = trace.tb_lineno if trace.tb_frame.f_code.co_filename == path else line
        trace = trace.tb_next
    told = " ".join(str(error.msg if isinstance(error, SyntaxError) else error).split())
    if isinstance(error, SyntaxError):
        told = f"not Python: {told}"
    elif not isinstance(error, CompropeError | _WrongError | ImportError):
        told = f"{type(error).__name__}: {told}"
    return f"{path}, line {line}: {told}" if line else f"{path}: {told}"


def _refuse_imports(tree: ast.Module) -> None:
    told = f"of comprope, only `from {API} import ...` is accepted, since an FMU has no more"
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            wrong = [node.module or "."] if node.level or (_ours(str(node.module)) and node.module != API) else []
        else:
            wrong = [one.name for one in node.names if _ours(one.name)] if isinstance(node, ast.Import) else []
        for name in wrong:
            raise _WrongError(f"imports {name}; {told}", getattr(node, "lineno", 0))


def _ours(module: str) -> bool:
    return module.partition(".")[0] == "comprope"


def _require_declared(made: dict[str, type[Effect]], module: types.ModuleType, tree: ast.Module) -> None:
    """Refuse effects without quantities or hooks, quantities that are none, and hooks that cannot be called."""
    lines = {node.name: node.lineno for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    if not any(effect.hooks for effect in made.values()):
        raise _WrongError("no effect that acts; register(EFFECT) and acts(EFFECT, ...) are needed, see docs/own_effect.md", 0)
    for effect in made.values():
        _require_quantities(effect, lines.get(effect.__name__, 0))
        for hook, function in effect.hooks.items():
            _require_kernel(hook, function, module, lines)


def _require_quantities(effect: type[Effect], line: int) -> None:
    numbers = {one.name: one for one in quantities(effect)}
    form = "quantity(unit, help, minimum, maximum)"
    if not numbers:
        raise _WrongError(f"{effect.__name__} has no quantity; `size: float = {form}` is one", line)
    for name in effect.model_fields:
        if name not in numbers:
            raise _WrongError(f"{effect.__name__}.{name}: not declared by {form}", line)
        if wrong := _quantity_problem(numbers[name]):
            raise _WrongError(f"{effect.__name__}.{name}: {wrong}", line)


def _quantity_problem(one: Quantity) -> str | None:
    from ...fmi.units import exponents

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
        raise _WrongError(f"{hook}={name}: a function of this file is accepted", line)
    if function is plain and not jit.PURE:
        raise _WrongError(f"{name}: not a kernel; write @kernel above it", line)
    arguments = ", ".join(plain.__code__.co_varnames[: plain.__code__.co_argcount])
    if arguments != HOOKS[hook]:
        unpacked = ", where ck, cc = weights" if hook == "tangents" else ""
        raise _WrongError(f"{name}({arguments}): for {hook} the arguments ({HOOKS[hook]}) are accepted{unpacked}", line)
