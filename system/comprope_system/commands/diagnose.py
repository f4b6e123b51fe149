"""`comprope diagnose`: which physical effect is missing."""

from typing import Annotated

import typer

import comprope_system

from ._parameters import CAMPAIGN, EXECUTOR, JOBS, JSON, REPORT
from ._terminal import OutputFile, finish, progress_display, require_files

WITHOUT = Annotated[list[str] | None, typer.Option(metavar="EFFECT", help="Exclude an effect. Repeatable.")]


def diagnose(
    campaign: CAMPAIGN,
    json: JSON = None,
    report: REPORT = None,
    jobs: JOBS = None,
    executor: EXECUTOR = None,
    without: WITHOUT = None,
) -> None:
    """Identify the physical effect that is missing from the model, with its probability and detection limits.

    Runs with role "validate" are used for neither fit nor ranking: they show whether the effect holds in other runs.
    """
    require_files(OutputFile(json), OutputFile(report, "page"))
    with progress_display() as progress:
        result = comprope_system.diagnose(
            campaign, without=without or (), executor=executor, jobs=jobs, previews=report is not None, progress=progress
        )
    finish(result, (json, result.save_json), (report, result.save_html))
