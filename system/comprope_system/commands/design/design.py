"""`comprope design`: smallest sheave mass and sensor heights."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

import comprope_system

from .._parameters import EXECUTOR, JOBS, numbers
from .._terminal import OutputFile, finish, progress_display, require_files

MODEL = Annotated[str, typer.Argument(metavar="MODEL.toml", help="Model file, or a preset: tower50, building200.")]
DRIVE = Annotated[Path | None, typer.Option(metavar="D.toml", help="Drive file; default that of the preset.")]
LIMIT = Annotated[float, typer.Option(metavar="MM", min=1e-3, help="Limit of the swing during and after a trip.")]
FLOORS = Annotated[int, typer.Option(metavar="N", min=2, max=60, help="Number of equally spaced floors for the trips.")]
AMPLITUDE = Annotated[float, typer.Option(metavar="MM", min=0.0, help="Amplitude of the building sway at the top landing.")]
PERIOD = Annotated[float | None, typer.Option(metavar="S", min=0.1, help="Period of the building sway; default no sway.")]
DURATION = Annotated[float, typer.Option(metavar="S", min=1.0, max=3600.0, help="Duration of the building sway.")]
SWAY_LIMIT = Annotated[
    float | None, typer.Option(metavar="MM", min=1e-3, help="Limit of the swing under building sway; default none.")
]
SENSORS = Annotated[int, typer.Option(metavar="N", min=1, max=20, help="Number of sensors to place.")]
SET = Annotated[
    list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change a value: sheave.radius=0.3. Repeatable.")
]
STOPS = Annotated[bool, typer.Option("--stops", help="Stop the car at every floor too: rise of the sheave, forces, slack.")]
WALL = Annotated[float | None, typer.Option(metavar="MM", help="Distance of the shaft's wall: clearance of the rope.")]
ROPE_LENGTHS = Annotated[
    str | None, typer.Option(metavar="MM,MM,...", help="Ropes of one sheave: how much longer each is; how they share it.")
]
ROPE_STIFFNESS = Annotated[str | None, typer.Option(metavar="X,X,...", help="EA of each of these ropes over the model's.")]
OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder for HTML page, figures and result.json.")]
JSON = Annotated[Path | None, typer.Option(metavar="F.json", help="Write the result to this file as well.")]


STORE = "runs.jsonl"  # in that folder: results as they come


@dataclass(frozen=True)
class Demands:
    """Requirements of the design."""

    drive: DRIVE = None
    limit: LIMIT = 10.0
    floors: FLOORS = 11
    sway_amplitude: AMPLITUDE = 50.0
    sway_period: PERIOD = None
    sway_duration: DURATION = 60.0
    sway_limit: SWAY_LIMIT = None
    sensors: SENSORS = 4
    changes: SET = None
    stops: STOPS = False
    wall: WALL = None
    rope_lengths: ROPE_LENGTHS = None
    rope_stiffness: ROPE_STIFFNESS = None

    @property
    def ropes(self) -> "comprope_system.RopeSet | None":
        """The ropes of the sheave, if they differ."""
        lengths, stiffness = numbers("rope-lengths", self.rope_lengths), numbers("rope-stiffness", self.rope_stiffness)
        if not lengths and not stiffness:
            return None
        return comprope_system.RopeSet(tuple(1e-3 * one for one in lengths) or (0.0,) * len(stiffness), stiffness)

    @property
    def options(self) -> "comprope_system.DesignOptions":
        """The same in SI units."""
        sway = None
        if self.sway_period:
            sway = comprope_system.BuildingSway(1e-3 * self.sway_amplitude, self.sway_period, self.sway_duration)
        sway_limit = None if self.sway_limit is None else 1e-3 * self.sway_limit
        wall = None if self.wall is None else 1e-3 * self.wall
        return comprope_system.DesignOptions(
            1e-3 * self.limit, self.floors, sway, sway_limit, self.sensors, self.stops, wall, self.ropes
        )


@dataclass(frozen=True)
class Work:
    """Execution and output files."""

    out: OUT = Path("design")
    json: JSON = None
    jobs: JOBS = None
    executor: EXECUTOR = None


def design(model: MODEL, demands: Demands, work: Work) -> None:
    """Compute the smallest sheave mass that meets a limit of the swing on all trips between floors and under building sway.

    Also computes sensor heights, and a map of resonances: natural periods of the rope against sway and trip durations.
    """
    from ...sheave_design.result import PAGE

    require_files(OutputFile(work.out / PAGE), OutputFile(work.json))
    with progress_display() as progress:
        result = comprope_system.design(
            model, demands.options, drive=demands.drive, changes=demands.changes, checkpoint=work.out / STORE,
            executor=work.executor, jobs=work.jobs, progress=progress,
        )  # fmt: skip
    result.save_files(work.out)
    finish(result, (work.json, result.save_json))
    typer.echo(f"written {work.out / PAGE}")
