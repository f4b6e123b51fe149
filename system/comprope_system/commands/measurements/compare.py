"""`comprope compare`: a model against measurements."""

from pathlib import Path
from typing import Annotated

import typer

import comprope_system

from .._parameters import CAMPAIGN, JSON, REPORT
from .._terminal import OutputFile, finish, progress_display, require_files

MODELS = Annotated[
    list[Path] | None, typer.Option("--model", metavar="FILE.toml", help="Compare another model with the same runs. Repeatable.")
]


def compare(campaign: CAMPAIGN, models: MODELS = None, json: JSON = None, report: REPORT = None) -> None:
    """Simulate the model with the measured car motion, and compute its error for each channel.

    Errors by run, channel and phase of the trip; remarks on the quality of the data.
    """
    require_files(OutputFile(json), OutputFile(report, "page"))
    with progress_display() as progress:
        result = comprope_system.compare(
            campaign, models=models or (), previews=report is not None, progress=progress
        )
    finish(result, (json, result.save_json), (report, result.save_html))
