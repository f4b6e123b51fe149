"""`comprope add`: an effect fitted into a model."""

from typing import Annotated

import typer

import comprope_system

from .._parameters import CAMPAIGN, EXECUTOR, FMU, JOBS, JSON, NEW_MODEL, REPORT, ROPE_FMU
from .._terminal import OutputFile, finish, progress_display, require_files

EFFECT = Annotated[str, typer.Argument(metavar="EFFECT", help="Such as air_drag; an instrument's as sensor_gain.cw_low.")]


def add(
    campaign: CAMPAIGN,
    effect: EFFECT,
    out: NEW_MODEL = None,
    json: JSON = None,
    report: REPORT = None,
    fmu: FMU = None,
    jobs: JOBS = None,
    executor: EXECUTOR = None,
) -> None:
    """Add an effect to the campaign's model, fitted on its fit runs, and report the error before and after.

    An effect that the model has already is refitted. The first lines of the new model file say what was fitted.
    """
    require_files(OutputFile(json), OutputFile(out), OutputFile(report, "page"), OutputFile(fmu and fmu / ROPE_FMU))
    with progress_display() as progress:
        result = comprope_system.add(campaign, effect, executor=executor, jobs=jobs, progress=progress)
    finish(result, (out, result.save_model), (json, result.save_json), (report, result.save_html), (fmu, result.save_fmus))
