"""`comprope new`: a campaign from raw logger files."""

import sys
from pathlib import Path
from typing import Annotated

import typer

import comprope_system

from .._parameters import JSON
from .._terminal import OutputFile, finish, require_files

FOLDER = Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="Folder in which campaign.toml is written.")]
FILES = Annotated[
    list[Path], typer.Argument(metavar="FILE...", help="Files of a logger; those of one run may be joined: drive.csv+lasers.csv.")
]
MODEL = Annotated[str | None, typer.Option(metavar="MODEL.toml", help="Model file, data sheet or preset; default tower50.")]
YES = Annotated[bool, typer.Option("--yes", help="Ask nothing.")]


def new(campaign: FOLDER, files: FILES, model: MODEL = None, yes: YES = False, json: JSON = None) -> None:
    """Describe raw logger files: find their columns, units, signs, noise and rests, and write campaign.toml.

    Says what each column was taken for and how surely; asks on a terminal what the files do not tell. Nothing is overwritten.
    """
    require_files(OutputFile(json))
    asking = None if yes or not sys.stdin.isatty() else _ask
    result = comprope_system.new(campaign, files, model=model, ask=asking)
    finish(result, (json, result.save_json))
    if result.check.problems:
        raise typer.Exit(2)


def _ask(question: str, default: str) -> str:
    answer: str = typer.prompt(question, default=default)
    return answer
