"""`comprope modes`: natural periods and shapes of the suspended rope."""

from pathlib import Path
from typing import Annotated

import typer

MODEL = Annotated[str, typer.Argument(metavar="MODEL.toml", help="Model file, or a preset: tower50, tower50_light, building200.")]
CAR = Annotated[float, typer.Option(metavar="M", help="Height of the car above the bottom landing.")]
COUNT = Annotated[int, typer.Option(metavar="N", min=1, max=200, help="How many modes, slowest first.")]
SET = Annotated[list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change a value: sheave.mass=90. Repeatable.")]
PLOT = Annotated[Path | None, typer.Option(metavar="F.png", help="Draw the shapes; .pdf and .svg are fine too.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write periods and shapes.")]


def modes(model: MODEL, car: CAR = 0.0, count: COUNT = 10, changes: SET = None, plot: PLOT = None, json: JSON = None) -> None:
    """Natural periods and shapes of the rope at rest, for any car position.

    Small motions about the shape at rest: the rope sticks to a sheave that is free to turn and to rise. Beside each
    lateral mode stands the period of an ideal hanging string.
    """
    from ..modal.workflow import Request, run

    run(Request(model, car, count, tuple(changes or ()), plot, json))
