"""`comprope diagnose`: which physical effect is missing."""

from pathlib import Path
from typing import Annotated

import typer

CAMPAIGN = Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml, or that file.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result.")]
REPORT = Annotated[Path | None, typer.Option(metavar="F.html", help="Write a page with pictures.")]
JOBS = Annotated[int | None, typer.Option(metavar="N", min=1, help="Processes; default one for each core.")]
WITHOUT = Annotated[list[str] | None, typer.Option(metavar="EFFECT", help="Rule an effect out; may be given again.")]


def diagnose(
    campaign: CAMPAIGN, json: JSON = None, report: REPORT = None, jobs: JOBS = None, without: WITHOUT = None
) -> None:
    """Say which physical effect the model lacks, how surely, and what the data cannot tell.

    Runs with role "validate" are used for neither fit nor ranking: they show whether the effect holds elsewhere.
    """
    from ..identification.workflow import Request
    from ..identification.workflow import diagnose as run

    run(Request(campaign, json, report, jobs=jobs, without=tuple(without or ())))
