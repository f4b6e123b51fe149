"""`comprope building`: a synthetic record of the building's motion."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

import comprope_system
from comprope.errors import InputError

from ._parameters import MODEL, SET
from ._terminal import OutputFile, finish, require_files

KIND = Annotated[str, typer.Argument(metavar="KIND", help="earthquake, of long period, or wind.")]
PERIOD = Annotated[float | None, typer.Option(metavar="S", help="Period of the first mode; default height / 46 Hz m.")]
PEAK = Annotated[
    float | None, typer.Option(metavar="X", help="Peak ground acceleration, default 0.3 m/s2; in wind rms of the top, 0.05 m.")
]
DURATION = Annotated[float, typer.Option(metavar="S", help="Duration of the record.")]
DAMPING = Annotated[float | None, typer.Option(metavar="X", help="Damping ratio; default 0.02 in an earthquake, 0.01 in wind.")]
SOIL = Annotated[float, typer.Option(metavar="S", help="Period of the soil in an earthquake.")]
WIND_SPEED = Annotated[float, typer.Option(metavar="M/S", help="Mean speed of the wind.")]
WIDTH = Annotated[float, typer.Option(metavar="M", help="Width of the building across the wind.")]
SEED = Annotated[int, typer.Option(metavar="N", help="Equal seeds give equal records.")]
TOP = Annotated[float | None, typer.Option(metavar="M", help="Height of the building; default the top landing.")]
OUT = Annotated[Path | None, typer.Option(metavar="FILE.csv", help="Write the record.")]
SHAKEN = Annotated[Path | None, typer.Option("--model", metavar="FILE.toml", help="Write the model with this building.")]
PLOT = Annotated[Path | None, typer.Option(metavar="FILE.png", help="Plot the record and its spectrum; .png, .pdf or .svg.")]
REPORT = Annotated[Path | None, typer.Option(metavar="F.html", help="Write an HTML page.")]


@dataclass(frozen=True)
class Motion:
    """How the record is made."""

    period: PERIOD = None
    peak: PEAK = None
    duration: DURATION = 120.0
    damping: DAMPING = None
    soil_period: SOIL = 4.0
    speed: WIND_SPEED = 25.0
    width: WIDTH = 40.0
    seed: SEED = 0


@dataclass(frozen=True)
class Files:
    """Output files."""

    out: OUT = None
    shaken: SHAKEN = None
    plot: PLOT = None
    report: REPORT = None


def building(kind: KIND, model: MODEL, motion: Motion, files: Files, top: TOP = None, changes: SET = None) -> None:
    """Make a synthetic record of the building's motion, in a long-period earthquake or in gusts of wind.

    The record has the displacement of the building at eleven heights. With --model a model file is written that replays it:
    `comprope simulate` moves the rope's ends, the sheave's guides and the sensors with the building.
    """
    require_files(
        OutputFile(files.out), OutputFile(files.shaken), OutputFile(files.plot, "picture"), OutputFile(files.report, "page")
    )
    if files.shaken and not files.out:
        raise InputError("--model: accepted with --out FILE.csv, the record that the model names")
    given: dict[str, Any] = {name: value for name, value in vars(motion).items() if value is not None}
    result = comprope_system.building(model, kind, top=top, changes=changes, **given)  # type: ignore[arg-type]
    finish(result, (files.out, result.to_csv), (files.plot, result.save_plot), (files.report, result.save_html))
    if files.shaken and files.out:
        result.save_model(files.shaken, files.out)
        typer.echo(f"written {files.shaken}")
    elif files.out:
        typer.echo(f"\nfor a model file beside the record:\n\n{result.toml(files.out.name)}")
