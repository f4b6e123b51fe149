"""Sweep: many independent cases on any executor, resumable after an interruption.

A sweep is a function of one case and a list of cases. Cases and results are what JSON can hold. Each
result goes into a file of JSON lines as it comes, under a key made of the function's name, the case and
the program's own source; a sweep started again reads that file and runs only what is missing.
"""

import hashlib
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, as_completed
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import comprope
from comprope.atomic_files import require_writable
from comprope.errors import CompropeError, InputError, SimulationError

from .progress import Progress, no_progress

SOURCE_SUFFIXES = (".py", ".toml")

Case = Mapping[str, Any]
Task = Callable[[Case], Any]


@dataclass(frozen=True)
class Outcome:
    """Outcome of a case: its value, or the error message."""

    case: Case
    value: Any = None
    failed: str = ""


def sweep(
    task: Task,
    cases: Sequence[Case],
    executor: Executor | None = None,
    store: Path | None = None,
    label: str = "running",
    progress: Progress = no_progress,
) -> list[Outcome]:
    """`task(case)` for each case, in their order; without an executor one after the other in this process.

    `task` is a function at the top of a module that the executor's workers can import. A case that raises a
    `CompropeError` has failed; its outcome contains the message, and it is computed again next time. `progress` is called
    with `label`, the number of results that are there, and that of all.
    """
    keys = [key_of(task, case) for case in cases]
    done = _read(store) if store else {}
    missing = {key: case for key, case in zip(keys, cases, strict=True) if key not in done}
    total = len(set(keys))
    known = total - len(missing)
    progress(label, known, total)
    for count, (key, outcome) in enumerate(_run(task, missing, executor), known + 1):
        done[key] = outcome
        if store:
            _append(store, key, outcome)
        progress(label, count, total)
    return [done[key] for key in keys]


def values(outcomes: Sequence[Outcome]) -> list[Any]:
    """The values of outcomes; raises `SimulationError` that names the first case that failed, if one has."""
    for outcome in outcomes:
        if outcome.failed:
            raise SimulationError(f"{dict(outcome.case)}: {outcome.failed}")
    return [outcome.value for outcome in outcomes]


def key_of(task: Task, case: Case) -> str:
    """The key of a case's result: a hash of the function's name and module, the case, and the source of the program.

    A case must therefore hold all that its result depends on: a model as a table, not the name of its file. Only the user's
    effects are named in a model by their files, so that the content of these counts too.
    """
    effects = [Path(file) for file in case["model"].get("own_effects", ())] if isinstance(case.get("model"), Mapping) else []
    text = json.dumps([task.__qualname__, _source(task.__module__), hash_of_files(effects), case], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:24]


@cache
def _source(module: str) -> str:
    """Hash of the source of both packages and of the task's own module: results of another version are computed again."""
    own = Path(sys.modules[module].__file__ or "")
    return hash_of_files([*source_files(), own] if own.is_file() else source_files(), module)


def source_files() -> list[Path]:
    """Every file of this program that a result can depend on: code and presets of `comprope` and `comprope_system`."""
    folders = (Path(comprope.__file__).parent, Path(__file__).parents[1])
    return sorted(path for folder in folders for path in folder.rglob("*") if path.suffix in SOURCE_SUFFIXES)


def hash_of_files(paths: Sequence[Path], prefix: str = "") -> str:
    """Hash of the names and the contents of files."""
    digest = hashlib.sha256(prefix.encode())
    for path in paths:
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _run(task: Task, cases: Mapping[str, Case], executor: Executor | None) -> Iterator[tuple[str, Outcome]]:
    """Keys and outcomes in order of completion."""
    if executor is None:
        for key, case in cases.items():
            yield key, attempt(task, case)
        return
    futures: dict[Future[Outcome], str] = {executor.submit(attempt, task, case): key for key, case in cases.items()}
    try:
        for future in as_completed(futures):
            yield futures[future], future.result()
    finally:
        for future in futures:
            future.cancel()


def attempt(task: Task, case: Case) -> Outcome:
    """Compute one case, on any machine."""
    try:
        return Outcome(case, task(case))
    except CompropeError as error:
        return Outcome(case, failed=str(error))


def _read(store: Path) -> dict[str, Outcome]:
    """Outcomes in a file by key, except failed ones; a truncated last line is ignored."""
    try:
        lines = store.read_text(encoding="utf-8").splitlines() if store.exists() else []
    except (OSError, UnicodeDecodeError):
        raise InputError(f"{store}: cannot be read; a file of results by an earlier sweep is accepted") from None
    found = {}
    for line in lines:
        try:
            row = json.loads(line)
            found[row["key"]] = Outcome(row["case"], row["value"])
        except (json.JSONDecodeError, KeyError, TypeError):
            continue
    return found


def _append(store: Path, key: str, outcome: Outcome) -> None:
    """Append one line, after a newline if the file ends with a truncated line."""
    if not store.exists():
        require_writable(store)
        store.parent.mkdir(parents=True, exist_ok=True)
    told = {"failed": outcome.failed} if outcome.failed else {"value": outcome.value}
    cut = store.exists() and store.stat().st_size > 0 and not store.read_bytes().endswith(b"\n")
    with store.open("a", encoding="utf-8") as file:
        file.write("\n" * cut + json.dumps({"key": key, "case": dict(outcome.case)} | told) + "\n")
