"""Terminal output and output files of the commands."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from comprope.atomic_files import require_writable

if TYPE_CHECKING:
    from ..parallel.progress import Progress as Report
    from ..report.result import Result


@contextmanager
def progress_display() -> "Iterator[Report]":
    """Progress bar on a terminal: current task, completed fraction and elapsed time; otherwise nothing."""
    console = Console(file=sys.stderr)
    if not console.is_terminal:
        yield lambda text, done, total: None
        return
    parts = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    # An FMU's messages on standard error are captured while it is called, so the display leaves the streams alone.
    display = Progress(*parts, console=console, transient=True, redirect_stdout=False, redirect_stderr=False)
    with display:
        task = display.add_task("starting", total=None)
        yield lambda text, done, total: display.update(task, description=text, completed=done, total=total or None)


@dataclass(frozen=True)
class OutputFile:
    """An optional output file of a command, and its kind, which determines the accepted extensions."""

    path: Path | None
    kind: str | None = None


def require_files(*files: OutputFile) -> None:
    """Raise `InputError` for files that cannot be written, before a long computation."""
    for one in files:
        if one.path:
            require_writable(one.path, one.kind)


def without_control_characters(line: str) -> str:
    """A line without characters that change a terminal; names in it may come from anybody's files."""
    return "".join(one if one.isprintable() or one == "\t" else "\N{REPLACEMENT CHARACTER}" for one in line)


def finish(result: "Result", *files: tuple[Path | None, Callable[[Path], None]]) -> None:
    """Print the summary of the result, then write each output file, completely or not at all, and print its name."""
    sys.stdout.write("".join(f"{without_control_characters(line)}\n" for line in result.summary().split("\n")))
    for path, save in files:
        if path:
            save(path)
            sys.stdout.write(f"written {path}\n")
