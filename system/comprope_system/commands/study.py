"""`comprope study`: the paper's results, stated and obtained side by side."""

from pathlib import Path
from typing import Annotated

import typer

from ._parameters import EXECUTOR, JOBS
from ._terminal import progress_display

NAMES = Annotated[
    list[str] | None, typer.Argument(metavar="[NAME]...", help="fig4, fig5, fig6, fig7, period, fig8, design; default all.")
]
OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder for page, figures and results.")]
BUILDING = Annotated[str, typer.Option(metavar="MODEL.toml", help="design: model file or preset.")]
DISTANCE = Annotated[float, typer.Option(metavar="M", min=0.5, help="design: running distance up from the bottom landing.")]
LIMIT = Annotated[float, typer.Option(metavar="MM", min=1e-3, help="design: largest displacement from rest that is allowed.")]


def study(
    names: NAMES = None,
    out: OUT = Path("studies"),
    jobs: JOBS = None,
    executor: EXECUTOR = None,
    building: BUILDING = "building200",
    distance: DISTANCE = 22.0,
    limit: LIMIT = 5.0,
) -> None:
    """Compute the results of the paper and set them beside what it states, in one page with figures.

    `design` answers which least sheave weight keeps the displacement under a limit. An interrupted run goes on
    where it stopped when it is started again with the same folder.
    """
    from ..studies.study import StudyOptions
    from ..studies.workflow import Request, run

    with progress_display() as progress:
        run(Request(names or (), out, jobs, executor, StudyOptions(building, distance, 1e-3 * limit)), progress)
