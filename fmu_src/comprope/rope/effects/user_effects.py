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
from ..parameters.parameter_vector import DECLARED
from . import public_names
from .base import REGISTRY
from .checks.file_checks import FileError, refuse_imports, require_declared

API = "comprope.effect"  # the module that such a file imports; see `_api_importable`


@dataclass(frozen=True)
class UserFile:
    """An executed file: its source and the names of its effects."""

    text: str
    effects: tuple[str, ...]


FILES: dict[str, UserFile] = {}  # by absolute path
_LOCK = threading.RLock()


def load_file(path: Path, *, allow_code: bool = False) -> None:
    """Run the file at an absolute path, unless a file of this content has been run.

    Raises `InputError` without consent, which is `allow_code` or the environment variable of `consent`, and for a file that
    cannot be read, fails, or has changed since it was run.
    """
    text = read_text_file(path)
    if _file_of(text) is None and not (allow_code or consent.given()):
        allow = f"comprope --allow-code ..., build_fmu.py --allow-code, or {consent.VARIABLE}=1"
        raise InputError(f"{path} would be executed as a program; inspect it, then allow it: {allow}")
    run_source(str(path), text)


def run_source(path: str, text: str) -> None:
    """Execute the source of the file `path`, unless it has been executed before."""
    with _LOCK:
        if path in FILES and FILES[path].text != text:
            raise InputError(f"{path}: has changed since it was run; start the program again")
        FILES[path] = _file_of(text) or UserFile(text, _run(path, text))


@contextmanager
def temporarily_registered(path: str, text: str) -> Iterator[None]:
    """Context in which an internal effect is registered temporarily."""
    kept: list[tuple[Any, dict[str, Any]]] = [(table, dict(table)) for table in (REGISTRY, DECLARED, FILES)]
    run_source(path, text)
    try:
        yield
    finally:
        for table, before in kept:
            table.clear()
            table.update(before)


def _file_of(text: str) -> UserFile | None:
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
        refuse_imports(tree, API)
        with _api_importable():
            exec(compile(tree, path, "exec"), module.__dict__)
        made = {key: one for key, one in REGISTRY.items() if key not in effects}
        require_declared(made, module, tree)
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
def _api_importable() -> Iterator[None]:
    """While a file runs, API has the public names, whatever this package is called: in an FMU it has another name."""
    kept = sys.modules.get(API)
    sys.modules[API] = types.ModuleType(API)
    vars(sys.modules[API]).update({name: getattr(public_names, name) for name in public_names.__all__})
    try:
        yield
    finally:
        if kept is None:
            del sys.modules[API]
        else:
            sys.modules[API] = kept


def _sentence(path: str, error: BaseException) -> str:
    """One sentence with file and line for any exception raised by a file."""
    line = getattr(error, "line", None) or getattr(error, "lineno", None)
    trace = error.__traceback__
    while trace is not None and not isinstance(error, FileError | SyntaxError):
        line = trace.tb_lineno if trace.tb_frame.f_code.co_filename == path else line
        trace = trace.tb_next
    text = " ".join(str(error.msg if isinstance(error, SyntaxError) else error).split())
    if isinstance(error, SyntaxError):
        text = f"not Python: {text}"
    elif not isinstance(error, CompropeError | FileError | ImportError):
        text = f"{type(error).__name__}: {text}"
    return f"{path}, line {line}: {text}" if line else f"{path}: {text}"
