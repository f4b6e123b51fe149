"""Arguments and options shared by several commands, and commands with options grouped in dataclasses."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

from comprope.errors import InputError

from ._terminal import OutputFile, finish, require_files

if TYPE_CHECKING:
    from comprope_system import AddResult, BuildingResult, ImproveResult, SwayResult

MODEL = Annotated[str, typer.Argument(metavar="MODEL.toml", help="Model file, or a preset: tower50, tower50_light, building200.")]
SET = Annotated[list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change a value: sheave.mass=90. Repeatable.")]
CAMPAIGN = Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml, or that file.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result.")]
TABLE = Annotated[Path | None, typer.Option(metavar="F.csv", help="Write the result as a table.")]
PLOT = Annotated[Path | None, typer.Option(metavar="F.png", help="Plot the result; .png, .pdf or .svg.")]
REPORT = Annotated[Path | None, typer.Option(metavar="F.html", help="Write an HTML report with figures.")]
NEW_MODEL = Annotated[Path | None, typer.Option(metavar="MODEL.toml", help="Write the new model.")]
FMU = Annotated[Path | None, typer.Option("--fmu", metavar="DIR", help="Write the FMUs of the new model and of the drive.")]
JOBS = Annotated[int | None, typer.Option(metavar="N", min=1, help="Number of processes; default one per core.")]
EXECUTOR = Annotated[str | None, typer.Option(metavar="dask://HOST:PORT", help="Run on a Dask cluster.")]
ROPE_FMU = "CompensationRope.fmu"  # in the folder of --fmu


def numbers(option: str, text: str | None) -> tuple[float, ...]:
    """The numbers of an option; raises `InputError` for anything else."""
    try:
        return tuple(float(one) for one in text.split(",")) if text else ()
    except ValueError:
        raise InputError(f"{option} = {text}: numbers separated by commas are accepted") from None


@dataclass(frozen=True)
class ResultFiles:
    """Output files of a command whose result is a table and a picture."""

    out: TABLE = None
    plot: PLOT = None
    json: JSON = None
    report: REPORT = None

    def require(self) -> None:
        """Raise `InputError` for a file that cannot be written, before a long computation."""
        require_files(
            OutputFile(self.out), OutputFile(self.plot, "picture"), OutputFile(self.json), OutputFile(self.report, "page")
        )

    def finish(self, result: "BuildingResult | SwayResult") -> None:
        """Print the summary of the result and write the files."""
        pages = (self.json, result.save_json), (self.report, result.save_html)
        finish(result, (self.out, result.to_csv), (self.plot, result.save_plot), *pages)


@dataclass(frozen=True)
class ModelFiles:
    """Output files of a command whose result is a new model."""

    out: NEW_MODEL = None
    json: JSON = None
    report: REPORT = None
    fmu: FMU = None

    def require(self) -> None:
        """Raise `InputError` for a file that cannot be written, before a long computation."""
        rope = self.fmu and self.fmu / ROPE_FMU
        require_files(OutputFile(self.json), OutputFile(self.out), OutputFile(self.report, "page"), OutputFile(rope))

    def finish(self, result: "AddResult | ImproveResult") -> None:
        """Print the summary of the result and write the files."""
        pages = (self.json, result.save_json), (self.report, result.save_html)
        finish(result, (self.out, result.save_model), *pages, (self.fmu, result.save_fmus))


def with_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command in the form typer expects: a parameter whose type is a dataclass is replaced by one for each of its fields."""
    groups: dict[str, Any] = {name: kind for name, kind in get_type_hints(command).items() if is_dataclass(kind)}
    if not groups:
        return command

    def called(**values: Any) -> None:
        made = {name: kind(**{one.name: values.pop(one.name) for one in fields(kind)}) for name, kind in groups.items()}
        command(**values, **made)

    parameters = [one for parameter in inspect.signature(command).parameters.values() for one in _separate(parameter)]
    called.__name__, called.__doc__ = command.__name__, command.__doc__
    called.__annotations__ = {one.name: one.annotation for one in parameters}
    called.__dict__["__signature__"] = inspect.Signature(parameters)
    return called


def _separate(parameter: inspect.Parameter) -> list[inspect.Parameter]:
    """The parameter itself, or one for each field of the dataclass that is its type."""
    kind = parameter.annotation
    if not is_dataclass(kind):
        return [parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY)]
    hints = get_type_hints(kind, include_extras=True)
    return [
        inspect.Parameter(one.name, inspect.Parameter.KEYWORD_ONLY, default=one.default, annotation=hints[one.name])
        for one in fields(kind)
    ]
