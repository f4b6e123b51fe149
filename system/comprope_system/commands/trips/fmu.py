"""`comprope fmu`: the FMUs of a rope model and of the drive."""

from pathlib import Path
from typing import Annotated

import typer

import comprope_system

from .._parameters import JSON, MODEL, SET
from .._terminal import OutputFile, finish, progress_display, require_files

OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder to write to.")]
SENSORS = Annotated[int | None, typer.Option(metavar="N", help="Number of displacement sensors; default those of the model.")]
NATIVE = Annotated[bool, typer.Option("--native", help="Also compile rope and drive, for importers without Python.")]
FMI3 = Annotated[bool, typer.Option("--fmi3", help="Also compile rope and drive for FMI 3.0.")]
SSP = Annotated[bool, typer.Option("--ssp", help="Also write drive and rope as one connected system, Elevator.ssp.")]


def fmu(
    model: MODEL,
    native: NATIVE = False,
    fmi3: FMI3 = False,
    ssp: SSP = False,
    sensors: SENSORS = None,
    changes: SET = None,
    out: OUT = Path("dist"),
    json: JSON = None,
) -> None:
    """Build the FMUs of rope and drive for co-simulation in other tools.

    The rope's parameters start at the values of the model, and can be changed in the importing tool. `--native` and `--fmi3`
    need a C compiler; `pip install ziglang` brings one for Linux, Windows and macOS at once.
    """
    require_files(OutputFile(out / "CompensationRope.fmu"), OutputFile(json))
    with progress_display() as progress:
        result = comprope_system.fmu(
            model, changes=changes, sensors=sensors, native=native, fmi3=fmi3, ssp=ssp, progress=progress
        )
    paths = result.save(out)
    finish(result, (json, result.save_json))
    typer.echo("\n".join(f"written {path}" for path in paths))
