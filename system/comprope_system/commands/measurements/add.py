"""`comprope add`: an effect fitted into a model."""

from typing import Annotated

import typer

import comprope_system

from .._parameters import CAMPAIGN, EXECUTOR, JOBS, ModelFiles
from .._terminal import progress_display

EFFECT = Annotated[str, typer.Argument(metavar="EFFECT", help="Such as air_drag; an instrument's as sensor_gain.cw_low.")]
START = Annotated[
    list[str] | None, typer.Option(metavar="KEY=VALUE", help="Begin at effects.air_drag.drag_coefficient=1. Repeatable.")
]


def add(
    campaign: CAMPAIGN, effect: EFFECT, files: ModelFiles, start: START = None, jobs: JOBS = None, executor: EXECUTOR = None
) -> None:
    """Add an effect to the campaign's model, fitted on its fit runs, and report the error before and after.

    An effect that the model has already is refitted. The first lines of the new model file say what was fitted.
    """
    files.require()
    with progress_display() as progress:
        result = comprope_system.add(campaign, effect, start=start, executor=executor, jobs=jobs, progress=progress)
    files.finish(result)
