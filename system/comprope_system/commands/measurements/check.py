"""`comprope check`: whether the files of a campaign can be used."""

import typer

import comprope_system

from .._parameters import CAMPAIGN, JSON, REPORT
from .._terminal import OutputFile, finish, require_files

BAD_INPUT = 2


def check(campaign: CAMPAIGN, json: JSON = None, report: REPORT = None) -> None:
    """Read all files of a campaign and check them, without a simulation.

    Problems, with which the campaign cannot be used, and remarks about what was left out or looks wrong. Exit status 2 if there
    is a problem.
    """
    require_files(OutputFile(json), OutputFile(report, "page"))
    result = comprope_system.check(campaign)
    finish(result, (json, result.save_json), (report, result.save_html))
    if result.problems:
        raise typer.Exit(BAD_INPUT)
