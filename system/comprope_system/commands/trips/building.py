"""`comprope building`: a synthetic record of the building's motion."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

import comprope_system
from comprope.errors import InputError

from .._parameters import MODEL, SET, ResultFiles
from .._terminal import OutputFile, require_files

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
SHAKEN = Annotated[Path | None, typer.Option("--model", metavar="FILE.toml", help="With --out: write a model with the record.")]


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


def building(
    kind: KIND, model: MODEL, motion: Motion, files: ResultFiles, shaken: SHAKEN = None, top: TOP = None, changes: SET = None
) -> None:
    """Make a synthetic record of the building's motion, in a long-period earthquake or in gusts of wind.

    The record has the displacement of the building at eleven heights. With --model a model file is written that replays it:
    `comprope simulate` moves the rope's ends, the sheave's guides and the sensors with the building.
    """
    files.require()
    require_files(OutputFile(shaken))
    if shaken and not files.out:
        raise InputError("--model: accepted with --out FILE.csv, the record that the model names")
    given: dict[str, Any] = {name: value for name, value in vars(motion).items() if value is not None}
    result = comprope_system.building(model, kind, top=top, changes=changes, **given)  # type: ignore[arg-type]
    files.finish(result)
    if shaken and files.out:
        result.save_model(shaken, files.out)
        typer.echo(f"written {shaken}")
    elif files.out:
        typer.echo(f"\nfor a model file beside the record:\n\n{result.toml(files.out.name)}")
