"""`comprope simulate`: one trip of drive and rope."""

from pathlib import Path
from typing import Annotated

import typer

MODEL = Annotated[str, typer.Argument(metavar="MODEL.toml", help="Model file, or a preset: tower50, tower50_light, building200.")]
FROM = Annotated[float | None, typer.Option("--from", metavar="M", help="Where the car starts; default the bottom landing.")]
TO = Annotated[float | None, typer.Option("--to", metavar="M", help="Where the car goes; default the top landing.")]
SPEED = Annotated[float | None, typer.Option(metavar="M/S", help="Rated speed.")]
ACCELERATION = Annotated[float | None, typer.Option(metavar="M/S2", help="Largest acceleration.")]
JERK = Annotated[float | None, typer.Option(metavar="M/S3", help="Largest jerk.")]
DRIVE = Annotated[Path | None, typer.Option(metavar="FILE.toml", help="Parameters of the drive, in tables as the FMU has them.")]
TIME = Annotated[float | None, typer.Option(metavar="S", help="How long to simulate; default the trip and 8 s at rest.")]
STEP = Annotated[float, typer.Option(metavar="S", help="Communication step of the co-simulation.")]
SET = Annotated[list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change a value: sheave.mass=90. Repeatable.")]
CAR = Annotated[Path | None, typer.Option(metavar="RUN.csv", help="Move the car as measured, and draw what was measured beside.")]
DIRECT = Annotated[bool, typer.Option("--direct", help="Step the models in this process instead of as FMUs; same numbers.")]
ONE_WAY = Annotated[bool, typer.Option("--one-way", help="The drive does not feel the rope.")]
OUT = Annotated[Path | None, typer.Option(metavar="FILE.csv", help="Write every communication step as a row.")]
PLOT = Annotated[Path | None, typer.Option(metavar="FILE.png", help="Draw the trip; .pdf and .svg are fine too.")]
REPORT = Annotated[
    Path | None,
    typer.Option(metavar="F.html", help="Write a page that plays the trip, and shows its figures; steps as --direct."),
]


def simulate(
    model: MODEL,
    start: FROM = None,
    end: TO = None,
    speed: SPEED = None,
    acceleration: ACCELERATION = None,
    jerk: JERK = None,
    drive: DRIVE = None,
    time: TIME = None,
    step: STEP = 0.01,
    changes: SET = None,
    car: CAR = None,
    direct: DIRECT = False,
    one_way: ONE_WAY = False,
    out: OUT = None,
    plot: PLOT = None,
    report: REPORT = None,
) -> None:
    """Co-simulate drive and rope through one trip of the car.

    The CSV file has a column for each sensor of the model: lateral displacement in metres, outward,
    empty where the rope's end has passed the sensor. All other columns are in SI units too.
    """
    from ..simulation.workflow import Motion, Request, run

    profile = {"speed": speed, "acceleration": acceleration, "jerk": jerk}
    motion = Motion(start, end, {key: value for key, value in profile.items() if value is not None}, drive, car)
    run(Request(model, motion, tuple(changes or ()), time, step, direct, one_way, out, plot, report))
