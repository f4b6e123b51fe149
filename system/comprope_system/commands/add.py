"""`comprope add`: an effect fitted into a model."""

from pathlib import Path
from typing import Annotated

import typer

CAMPAIGN = Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml, or that file.")]
EFFECT = Annotated[str, typer.Argument(metavar="EFFECT", help="Such as air_drag; an instrument's as sensor_gain.cw_low.")]
OUT = Annotated[Path | None, typer.Option(metavar="MODEL.toml", help="Write the new model.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result.")]
REPORT = Annotated[Path | None, typer.Option(metavar="F.html", help="Write a page with pictures.")]
JOBS = Annotated[int | None, typer.Option(metavar="N", min=1, help="Processes; default one for each core.")]


def add(campaign: CAMPAIGN, effect: EFFECT, out: OUT = None, json: JSON = None, report: REPORT = None, jobs: JOBS = None) -> None:
    """Add an effect to the campaign's model, fitted on its fit runs, and tell errors before and after.

    An effect that the model has already is fitted again. The new model file tells in its first lines what was fitted.
    """
    from ..identification.workflow import Request
    from ..identification.workflow import add as run

    run(Request(campaign, json, report, out, jobs), effect)
