"""`comprope simulate`: one trip of drive and rope."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any, cast

import typer

import comprope_system
from comprope.errors import InputError

from .._parameters import MODEL, SET
from .._terminal import OutputFile, finish, progress_display, require_files

FROM = Annotated[
    float | None,
    typer.Option("--from", metavar="M", help="Start position; default the bottom landing, with --car as the record has it."),
]
TO = Annotated[
    float | None,
    typer.Option("--to", metavar="M", help="Destination; default the top landing, with --car as the record has it."),
]
SPEED = Annotated[float | None, typer.Option(metavar="M/S", help="Rated speed.")]
ACCELERATION = Annotated[float | None, typer.Option(metavar="M/S2", help="Largest acceleration.")]
JERK = Annotated[float | None, typer.Option(metavar="M/S3", help="Largest jerk.")]
DRIVE = Annotated[Path | None, typer.Option(metavar="FILE.toml", help="Drive file: parameters of the drive, as in its FMU.")]
TIME = Annotated[float | None, typer.Option(metavar="S", help="Simulated time; default the trip and 8 s at rest.")]
STEP = Annotated[float, typer.Option(metavar="S", help="Communication step of the co-simulation.")]
CAR = Annotated[Path | None, typer.Option(metavar="RUN.csv", help="Prescribe the measured motion; plot measured signals too.")]
EXACT = Annotated[bool, typer.Option("--exact", help="With --car: take the motion as it is, without looking for a smooth trip.")]
STOP = Annotated[float | None, typer.Option(metavar="S", help="Stop the car at this time from the start of the simulation.")]
DECELERATION = Annotated[
    float | None, typer.Option(metavar="M/S2", help="Deceleration of the stop; default 3, gear alone 15, buffer alone 9.81.")
]
SAFETY_GEAR = Annotated[bool, typer.Option("--safety-gear", help="With --stop: the car's safety gear and the brake stop it.")]
BUFFER = Annotated[
    str | None,
    typer.Option(metavar="KIND", help="Run on to a buffer, hydraulic or spring: the car's or, upward, the counterweight's."),
]
BRAKE = Annotated[float | None, typer.Option(metavar="N.M", help="With --stop: the motor is off, the machine's brake on.")]
DIRECT = Annotated[bool, typer.Option("--direct", help="Simulate in this process instead of with FMUs; same numbers.")]
FMU = Annotated[
    list[Path] | None,
    typer.Option(metavar="FILE.fmu", help="Use, that is run, this FMU of drive or rope instead of our own. Repeatable."),
]
ONE_WAY = Annotated[bool, typer.Option("--one-way", help="One-way coupling: no forces of the rope on the drive.")]
OUT = Annotated[Path | None, typer.Option(metavar="FILE.csv", help="Write the results, one row per communication step.")]
PLOT = Annotated[Path | None, typer.Option(metavar="FILE.png", help="Plot the trip; .png, .pdf or .svg.")]
WALL = Annotated[float | None, typer.Option(metavar="MM", help="Distance of a wall: clearance of the rope; implies --direct.")]
CLEARANCE = Annotated[
    Path | None, typer.Option(metavar="FILE.png", help="Plot the clearance from --wall, or the model's walls; implies --direct.")
]
REPORT = Annotated[
    Path | None,
    typer.Option(metavar="F.html", help="Write an HTML page with an animation of the trip and plots; implies --direct."),
]


@dataclass(frozen=True)
class MotionOptions:
    """Motion of the car."""

    start: FROM = None
    end: TO = None
    speed: SPEED = None
    acceleration: ACCELERATION = None
    jerk: JERK = None
    drive: DRIVE = None


@dataclass(frozen=True)
class StopOptions:
    """A stop in which the trip ends."""

    stop: STOP = None
    deceleration: DECELERATION = None
    safety_gear: SAFETY_GEAR = False
    buffer: BUFFER = None
    brake: BRAKE = None

    @property
    def wanted(self) -> "comprope_system.Stop | None":
        """The stop, if one is asked for; raises `InputError` for one without a time."""
        given = [name for name in ("deceleration", "safety_gear", "brake") if getattr(self, name)]
        if self.stop is None and self.buffer is None:
            if given:
                raise InputError(f"--{given[0].replace('_', '-')}: accepted with --stop TIME or --buffer KIND")
            return None
        buffer = cast("Any", self.buffer)  # checked by `Stop`
        return comprope_system.Stop(self.stop or 0.0, self.deceleration, self.safety_gear, buffer, self.brake)


@dataclass(frozen=True)
class RunOptions:
    """Options of the simulation."""

    time: TIME = None
    step: STEP = 0.01
    changes: SET = None
    car: CAR = None
    exact: EXACT = False
    direct: DIRECT = False
    fmu: FMU = None
    one_way: ONE_WAY = False


@dataclass(frozen=True)
class Files:
    """Output files, and what they are about."""

    out: OUT = None
    plot: PLOT = None
    report: REPORT = None
    clearance: CLEARANCE = None
    wall: WALL = None

    @property
    def needs_clearance(self) -> bool:
        """Whether the clearance is asked for."""
        return self.clearance is not None or self.wall is not None


def simulate(model: MODEL, motion: MotionOptions, stop: StopOptions, options: RunOptions, files: Files) -> None:
    """Co-simulate drive and rope for one trip of the car.

    With `--stop TIME` the trip ends in a stop, with `--buffer` it goes on to a buffer. A mass that moves up flies on where the
    other one is stopped harder than by gravity, falls back and lands.

    The CSV file has a column for each sensor of the model: lateral displacement in metres, positive outward,
    empty while the rope's end has passed the sensor. All columns are in SI units.
    """
    require_files(OutputFile(files.out), OutputFile(files.plot, "picture"), OutputFile(files.report, "page"))
    require_files(OutputFile(files.clearance, "picture"))
    wall = None if files.wall is None else 1e-3 * files.wall
    if files.needs_clearance:
        _require_wall(model, options.changes, wall)
    with progress_display() as progress:
        result = comprope_system.simulate(
            model,
            comprope_system.CarMotion(**vars(motion), measured=options.car, exact=options.exact, stop=stop.wanted),
            changes=options.changes, duration=options.time, step=options.step,
            coupling="one-way" if options.one_way else "two-way",
            fmu=_fmus(options, files), progress=progress,
        )  # fmt: skip
    finish(
        result, (files.out, result.to_csv), (files.plot, result.save_plot), (files.report, partial(result.save_html, wall=wall))
    )
    if files.needs_clearance:
        typer.echo(result.clearance(wall).summary())
        if files.clearance:
            result.save_clearance(files.clearance, wall)
            typer.echo(f"written {files.clearance}")


def _require_wall(model: str, changes: list[str] | None, wall: float | None) -> None:
    """Raise `InputError` without a wall [m], before a long computation."""
    from ...simulation.trips.clearance import known_wall
    from ...simulation.trips.workflow import changed_model

    known_wall(changed_model(model, changes)[0], wall)


def _fmus(options: RunOptions, files: Files) -> bool | list[Path]:
    """Whether to simulate with FMUs, and which; raises `InputError` for contradictory options."""
    direct = options.direct or files.report is not None or files.needs_clearance
    if options.fmu and direct:
        others = "--direct, --report, --wall or --clearance"
        raise InputError(f"--fmu: an FMU does not output the rope's shape and is not used with {others}")
    return options.fmu or not direct
