"""`comprope diagnose`: which physical effect is missing."""

from pathlib import Path
from typing import Annotated

import typer

import comprope_system

from .._parameters import CAMPAIGN, EXECUTOR, JOBS, JSON, REPORT
from .._terminal import OutputFile, finish, progress_display, require_files

SKELETON = Annotated[Path | None, typer.Option(metavar="FILE.py", help="Write a file of an effect with the unknown one's force.")]
WITHOUT = Annotated[list[str] | None, typer.Option(metavar="EFFECT", help="Exclude an effect. Repeatable.")]


def diagnose(
    campaign: CAMPAIGN,
    json: JSON = None,
    report: REPORT = None,
    jobs: JOBS = None,
    executor: EXECUTOR = None,
    without: WITHOUT = None,
    skeleton: SKELETON = None,
) -> None:
    """Identify the physical effect that is missing from the model, with its probability and detection limits.

    Runs with role "validate" are used for neither fit nor ranking: they show whether the effect holds in other runs.
    """
    require_files(OutputFile(json), OutputFile(report, "page"), OutputFile(skeleton, "Python file"))
    with progress_display() as progress:
        result = comprope_system.diagnose(
            campaign, without=without or (), executor=executor, jobs=jobs, previews=report is not None, progress=progress
        )
    proposed = [(skeleton, result.save_skeleton)] if result.effect_skeleton else []
    finish(result, (json, result.save_json), (report, result.save_html), *proposed)
    if skeleton and not proposed:
        typer.echo(f"not written {skeleton}: only an unknown effect whose force follows the motion has a skeleton")
