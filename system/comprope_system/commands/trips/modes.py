"""`comprope modes`: natural periods and mode shapes of the suspended rope."""

from typing import Annotated

import typer

import comprope_system

from .._parameters import JSON, MODEL, PLOT, SET
from .._terminal import OutputFile, finish, require_files

CAR = Annotated[float, typer.Option(metavar="M", help="Height of the car above the bottom landing.")]
COUNT = Annotated[int, typer.Option(metavar="N", min=1, max=200, help="Number of modes, longest period first.")]


def modes(model: MODEL, car: CAR = 0.0, count: COUNT = 10, changes: SET = None, plot: PLOT = None, json: JSON = None) -> None:
    """Compute natural periods and mode shapes of the rope for a car position.

    Small vibration about the static equilibrium: the rope sticks to a sheave that is free to turn and to rise. For each
    lateral mode the period of an ideal hanging string is given for comparison.
    """
    require_files(OutputFile(plot, "picture"), OutputFile(json))
    result = comprope_system.modes(model, car, count, changes=changes)
    finish(result, (json, result.save_json), (plot, result.save_plot))
