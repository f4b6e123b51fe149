"""`comprope tune`: optimisation of trip profile, input shaper and servo gains."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

import comprope_system
from comprope.errors import InputError

from .._parameters import EXECUTOR, JOBS, SET
from .._terminal import OutputFile, finish, progress_display, require_files

MODEL = Annotated[str, typer.Argument(metavar="MODEL.toml", help="Model file, or a preset: tower50, building200.")]
DRIVE = Annotated[
    Path | None, typer.Option(metavar="D.toml", help="Present drive, whose limits are kept; default that of the preset.")
]
TRIP = Annotated[
    list[str] | None, typer.Option(metavar="FROM:TO", help="A trip in metres, e.g. 0:22. Repeatable; default six trips.")
]
TIMES = Annotated[str, typer.Option(metavar="F,F,...", help="Travel times to evaluate, relative to the present one.")]
EXTRA = Annotated[float, typer.Option(metavar="SHARE", min=0.0, max=2.0, help="Accepted relative increase of travel time.")]
LIMIT = Annotated[
    float | None, typer.Option(metavar="MM", min=1e-3, help="Instead of --extra: choose the fastest trip with less swing.")
]
WEIGHT = Annotated[
    float, typer.Option(metavar="W", min=0.0, max=1.0, help="Weight of the swing after the trip relative to that during it.")
]
SPREAD = Annotated[
    float, typer.Option(metavar="SHARE", min=0.0, max=0.5, help="Relative deviation of the sheave mass to be robust against.")
]
OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder for HTML page, figures, result.json and *.drive.toml.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result to this file as well.")]


STORE = "runs.jsonl"  # in that folder: results as they come


@dataclass(frozen=True)
class Wishes:
    """Trips and objective."""

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
    """Execution and output files."""

    out: OUT = Path("tuning")
    json: JSON = None
    jobs: JOBS = None
    executor: EXECUTOR = None


def tune(model: MODEL, wishes: Wishes, work: Work) -> None:
    """Optimise trip profile, input shaper and servo gains: least swing for a travel time, or least travel time for a swing.

    Speed, acceleration and jerk stay within the limits of the present drive. Candidates are found with a reduced linear model,
    evaluated with the full model and validated with the FMUs. An interrupted run is resumed if started with the same folder.
    """
    from ...tuning.result import PAGE

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
    """Travel times such as `1.05,1.2` in increasing order; raises `InputError` for invalid ones."""
    from ...tuning.workflow import MAX_TIME_FACTOR, SHORTEST

    try:
        found = sorted(float(one) for one in text.split(","))
    except ValueError:
        found = [math.nan]
    if not all(SHORTEST <= one <= MAX_TIME_FACTOR for one in found):
        raise InputError(f"--times {text}: numbers from {SHORTEST:g} to {MAX_TIME_FACTOR:g}, with commas between, are accepted")
    return found
