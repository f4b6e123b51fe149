"""`comprope journey`: add what is missing until nothing is."""

from pathlib import Path
from typing import Annotated

import typer

CAMPAIGN = Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml, or that file.")]
OUT = Annotated[Path | None, typer.Option(metavar="MODEL.toml", help="Write the new model.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result.")]
REPORT = Annotated[Path | None, typer.Option(metavar="F.html", help="Write a page with pictures.")]
JOBS = Annotated[int | None, typer.Option(metavar="N", min=1, help="Processes; default one for each core.")]


def journey(campaign: CAMPAIGN, out: OUT = None, json: JSON = None, report: REPORT = None, jobs: JOBS = None) -> None:
    """Diagnose, add, and again, until nothing is missing or no known effect helps; then take out what is not needed.

    Tells what each effect bought: its share of the fall of the error, on fitted runs and on runs held out.
    """
    from ..identification.workflow import Request
    from ..identification.workflow import journey as run

    run(Request(campaign, json, report, out, jobs))
