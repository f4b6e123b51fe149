"""`comprope tune`: a controller chosen against the rope."""

from pathlib import Path
from typing import Annotated

import typer

MODEL = Annotated[str, typer.Argument(metavar="MODEL.toml", help="Model file, or a preset: tower50, building200.")]
DRIVE = Annotated[
    Path | None, typer.Option(metavar="D.toml", help="Present drive; its limits are kept. Default the preset's own.")
]
TRIP = Annotated[
    list[str] | None, typer.Option(metavar="FROM:TO", help="A trip in metres, as 0:22. Repeatable; default six trips.")
]
TIMES = Annotated[str, typer.Option(metavar="F,F,...", help="Travel times of the front, over the present one.")]
EXTRA = Annotated[float, typer.Option(metavar="SHARE", min=0.0, max=2.0, help="Travel time that the chosen controller may add.")]
LIMIT = Annotated[
    float | None, typer.Option(metavar="MM", min=1e-3, help="Instead of --extra: the fastest trip that swings less.")
]
WEIGHT = Annotated[
    float, typer.Option(metavar="W", min=0.0, max=1.0, help="What the swing after the trip counts beside that during it.")
]
SPREAD = Annotated[
    float, typer.Option(metavar="SHARE", min=0.0, max=0.5, help="Be prepared for a sheave so much lighter or heavier.")
]
SET = Annotated[list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change a value: sheave.mass=90. Repeatable.")]
OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder for page, pictures, result.json and *.drive.toml.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result here too.")]
JOBS = Annotated[int | None, typer.Option(metavar="N", min=1, help="Processes; default one for each core.")]
EXECUTOR = Annotated[str | None, typer.Option(metavar="dask://HOST:PORT", help="Run on a Dask cluster.")]


def tune(
    model: MODEL,
    drive: DRIVE = None,
    trip: TRIP = None,
    times: TIMES = "1.05,1.1,1.2,1.35,1.5",
    extra: EXTRA = 0.1,
    limit: LIMIT = None,
    weight: WEIGHT = 0.5,
    spread: SPREAD = 0.0,
    changes: SET = None,
    out: OUT = Path("tuning"),
    json: JSON = None,
    jobs: JOBS = None,
    executor: EXECUTOR = None,
) -> None:
    """Choose profile, shaper and servo gains: the least swing of the rope for a travel time, or the least time for a swing.

    Speed, acceleration and jerk stay within the present drive's limits. Found on a small linear rope, judged on the full model,
    and installed as FMUs. An interrupted run goes on where it stopped when it is started again with the same folder.
    """
    from ..tuning.workflow import Request, run

    run(Request(model, drive, trip or (), times, extra, limit, weight, spread, tuple(changes or ()), out, json, jobs, executor))
