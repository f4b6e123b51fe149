"""The command `comprope`: finds its subcommands and turns errors into one line each and an exit status."""

import errno
import importlib
import io
import os
import pkgutil
import sys
from importlib import metadata
from typing import Annotated

import typer

from comprope import consent
from comprope.errors import CompropeError, InputError

from . import commands
from .commands._parameters import with_options
from .commands._terminal import without_control_characters

DONE, FAILED, BAD_INPUT = 0, 1, 2
_STREAM_ERRORS = (errno.EPIPE, errno.ENOSPC, errno.EBADF, errno.EIO)  # closed, full, absent, broken
# Matrices here are small: threads of the linear algebra would only wait for one another, for seconds on a busy machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

app = typer.Typer(rich_markup_mode="markdown", pretty_exceptions_enable=False)


def _print_version(wanted: bool) -> None:
    if wanted:
        try:
            typer.echo(f"comprope {metadata.version('comprope')}")
        except metadata.PackageNotFoundError:
            raise InputError("comprope is not installed; its version is in pyproject.toml") from None
        raise typer.Exit


VERSION = Annotated[bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")]
ALLOW_CODE = Annotated[bool, typer.Option("--allow-code", help="Allow a model file to run Python files of own effects.")]
OUTSIDE = Annotated[bool, typer.Option("--allow-outside", help="Allow a campaign to name run files outside of its folder.")]


@app.callback(invoke_without_command=True)
def _welcome(
    context: typer.Context, allow_code: ALLOW_CODE = False, allow_outside: OUTSIDE = False, version: VERSION = False
) -> None:
    """Lateral vibration of elevator compensation ropes: simulation, comparison with measurements, diagnosis of missing effects.

    First example: `comprope simulate tower50 --plot trip.png`. For MODEL.toml every command also accepts the name of a
    preset: tower50, tower50_light, building200.

    Compiled kernels and FMUs are kept in the folder that the environment variable COMPROPE_CACHE names, by default the user's
    cache folder (`~/.cache/comprope`); to empty the cache, delete it.
    """
    del version  # printed by its callback
    context.with_resource(consent.giving(allow_code))
    context.with_resource(consent.giving(allow_outside, consent.OUTSIDE))
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


PANELS = {  # of the help text: title, package, and commands in the order in which they are typically used
    "Simulate": ("trips", ("simulate", "modes", "building", "fmu")),
    "Compare with measurements": ("measurements", ("app", "new", "check", "compare", "diagnose", "add", "improve")),
    "Design and tuning": ("design", ("tune", "design", "sway")),
    "Verification": ("verification", ("verify", "study")),
}


def _register() -> None:
    """Every module of a package of `commands` is a command: the function that has the module's name."""
    for panel, (package, names) in PANELS.items():
        group = importlib.import_module(f"{commands.__name__}.{package}")
        found = [module.name for module in pkgutil.iter_modules(group.__path__)]
        for name in [*(one for one in names if one in found), *(one for one in found if one not in names)]:
            function = getattr(importlib.import_module(f"{group.__name__}.{name}"), name)
            app.command(name.replace("_", "-"), rich_help_panel=panel)(with_options(function))


_register()


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit: 0 done, 2 bad input, 1 anything else; errors are lines on standard error."""
    try:
        _prepare_streams()
        status = app(arguments, prog_name="comprope", standalone_mode=False)
        sys.stdout.flush()
    except SystemExit as stop:  # the end of shell completion, or typer's answer to a closed pipe
        status = stop.code
    except Exception as error:
        status, text = _explained(error)
        if sys.stderr is not None:
            sys.stderr.write("".join(f"{without_control_characters(line)}\n" for line in text.splitlines()))
    sys.exit(status or DONE)


def _prepare_streams() -> None:
    """Print a question mark for a character that the terminal's encoding lacks; raises `OSError` without standard output."""
    if sys.stdout is None:
        raise OSError(errno.EBADF, os.strerror(errno.EBADF))
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def _explained(error: Exception) -> tuple[int, str]:
    """The exit status and the text for an error."""
    if isinstance(error, InputError):
        return BAD_INPUT, str(error)
    if isinstance(error, CompropeError):
        return FAILED, str(error)
    if isinstance(error, OSError) and error.filename is None and error.errno in _STREAM_ERRORS:
        # What is left in the buffer would fail once more when Python ends.
        sys.stdout = open(os.devnull, "w")  # noqa: PTH123, SIM115
        return FAILED, f"standard output: cannot be written: {error.strerror}"
    if isinstance(error, typer.Abort):
        return FAILED, "stopped"
    if hasattr(error, "format_message"):  # typer's and click's errors in options and arguments
        command = getattr(getattr(error, "ctx", None), "command_path", "comprope")
        return BAD_INPUT, f"{' '.join(error.format_message().split()).rstrip('.')}; see `{command} --help`"
    return FAILED, f"internal error: {type(error).__name__}: {' '.join(str(error).split())}"


if __name__ == "__main__":
    main()
