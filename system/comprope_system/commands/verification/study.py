"""`comprope study`: reproduction of the results of the paper."""

from pathlib import Path
from typing import Annotated

import typer

from .._parameters import EXECUTOR, JOBS
from .._terminal import progress_display

NAMES = Annotated[
    list[str] | None, typer.Argument(metavar="[NAME]...", help="fig4, fig5, fig6, fig7, period, fig8, design; default all.")
]
OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder for HTML page, figures and results.")]
BUILDING = Annotated[str, typer.Option(metavar="MODEL.toml", help="design: model file or preset.")]
DISTANCE = Annotated[float, typer.Option(metavar="M", min=0.5, help="design: running distance up from the bottom landing.")]
LIMIT = Annotated[float, typer.Option(metavar="MM", min=1e-3, help="design: limit of the displacement relative to rest.")]


def study(
    names: NAMES = None,
    out: OUT = Path("studies"),
    jobs: JOBS = None,
    executor: EXECUTOR = None,
    building: BUILDING = "building200",
    distance: DISTANCE = 22.0,
    limit: LIMIT = 5.0,
) -> None:
    """Reproduce the results of the paper and compare them with the values it states, in an HTML page with figures.

    `design` computes the smallest sheave mass for a displacement limit. An interrupted run is resumed if it is
    started again with the same folder.
    """
    from ...studies.paper.study import StudyOptions
    from ...studies.paper.workflow import Request, run

    with progress_display() as progress:
        run(Request(names or (), out, jobs, executor, StudyOptions(building, distance, 1e-3 * limit)), progress)
