"""`comprope compare`: a model against measurements."""

from pathlib import Path
from typing import Annotated

import typer

CAMPAIGN = Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml, or that file.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result.")]
REPORT = Annotated[Path | None, typer.Option(metavar="F.html", help="Write a page with pictures.")]


def compare(campaign: CAMPAIGN, json: JSON = None, report: REPORT = None) -> None:
    """Drive the model as the car was driven, and set it against each channel.

    Errors are told for each run, channel and phase of the trip. Where the data themselves are odd, that is told too.
    """
    from ..identification.workflow import Request
    from ..identification.workflow import compare as run

    run(Request(campaign, json, report))
