"""`comprope tune`: a controller chosen against the rope."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

import comprope_system
from comprope.errors import InputError

from ._parameters import EXECUTOR, JOBS, SET
from ._terminal import OutputFile, finish, progress_display, require_files

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
OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder for page, pictures, result.json and *.drive.toml.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result here too.")]


STORE = "runs.jsonl"  # in that folder: results as they come


@dataclass(frozen=True)
class Wishes:
    """What is tuned, and what counts."""

    drive: DRIVE = None
    trip: TRIP = None
    times: TIMES = "1.05,1.1,1.2,1.35,1.5"
    extra: EXTRA = 0.1
    limit: LIMIT = None
    weight: WEIGHT = 0.5
    spread: SPREAD = 0.0
    changes: SET = None


@dataclass(frozen=True)
class Work:
    """Where it runs, and what is written."""

    out: OUT = Path("tuning")
    json: JSON = None
    jobs: JOBS = None
    executor: EXECUTOR = None


def tune(model: MODEL, wishes: Wishes, work: Work) -> None:
    """Choose profile, shaper and servo gains: the least swing of the rope for a travel time, or the least time for a swing.

    Speed, acceleration and jerk stay within the present drive's limits. Found on a small linear rope, judged on the full model,
    and installed as FMUs. An interrupted run goes on where it stopped when it is started again with the same folder.
    """
    from ..tuning.result import PAGE

    require_files(OutputFile(work.out / PAGE), OutputFile(work.json))
    options = comprope_system.TuningOptions(
        trips=wishes.trip or (), travel_times=read_times(wishes.times), extra_time=wishes.extra,
        swing_limit=None if wishes.limit is None else 1e-3 * wishes.limit,
        residual_weight=wishes.weight, mass_spread=wishes.spread,
    )  # fmt: skip
    with progress_display() as progress:
        result = comprope_system.tune(
            model, options, drive=wishes.drive, changes=wishes.changes, checkpoint=work.out / STORE,
            executor=work.executor, jobs=work.jobs, progress=progress,
        )  # fmt: skip
    result.save_files(work.out)
    finish(result, (work.json, result.save_json))
    typer.echo(f"written {work.out / PAGE}")


def read_times(text: str) -> list[float]:
    """Travel times such as `1.05,1.2`, rising; raises `InputError` if one is none."""
    from ..tuning.workflow import MAX_TIME_FACTOR, SHORTEST

    try:
        found = sorted(float(one) for one in text.split(","))
    except ValueError:
        found = [math.nan]
    if not all(SHORTEST <= one <= MAX_TIME_FACTOR for one in found):
        raise InputError(f"--times {text}: numbers from {SHORTEST:g} to {MAX_TIME_FACTOR:g}, with commas between, are accepted")
    return found
