"""What `comprope simulate` does: read, simulate, write, sum up."""

import sys
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from comprope.atomic_files import require_writable
from comprope.drive.parameters import Drive
from comprope.drive.trajectory.reference_trajectory import first_trajectory
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import load, with_changes
from comprope.rope.simulator.cosimulation import RopeSimulator
from comprope.rope.simulator.rope import CompensationRope

from ..cosim.in_process_participant import DirectParticipant
from ..presets import drive_path, model_path
from ..presets.overrides import assignments
from .animation.frames import Camera
from .elevator import Lift, driven, load_drive, prescribed
from .measured_run import Run, read_run
from .trip_simulation import Progress as Report
from .trip_simulation import Simulated, Timing, simulate, summary

SETTLE = 8.0  # s simulated after the trip, while the rope swings freely


@dataclass(frozen=True)
class Motion:
    """How the car moves: between two heights [m] by a drive with some limits changed, or as measured in a CSV file."""

    start: float | None = None
    end: float | None = None
    profile: Mapping[str, float] | None = None
    drive: Path | None = None
    car: Path | None = None


@dataclass(frozen=True)
class Request:
    """What a user asks for; `changes` are texts KEY=VALUE, times are in s."""

    model: str
    motion: Motion
    changes: tuple[str, ...] = ()
    duration: float | None = None
    step: float = 0.01
    direct: bool = False
    one_way: bool = False
    out: Path | None = None
    plot: Path | None = None
    report: Path | None = None


def run(request: Request) -> Simulated:
    """Simulate what is asked for, write its files and print a summary; raises `InputError` for bad input."""
    _require_files(request)
    model, drive_changes = _model(request)
    names = [sensor.name for sensor in model.sensors]
    measured = None
    if request.motion.car:
        measured = read_run(request.motion.car, model.shaft.height, names)
        model = with_changes(model, measured.changes | assignments(request.changes), "--set")
    lift, duration = _lift(request, model, drive_changes, measured)
    duration = duration if request.duration is None else request.duration
    timing = Timing(duration, request.step, "one-way" if request.one_way else "two-way")
    with lift as ready, _progress_bar() as bar:
        camera = Camera(partial(_rope, ready), timing.step) if request.report else None
        simulated = simulate(ready, names, timing, _both(bar, camera))
    _write(request, simulated, measured)
    if request.report and camera:
        from .animation.page import save_trip_page

        save_trip_page(request.report, request.model, model, simulated, camera, measured)
    _print(request, simulated)
    return simulated


def _both(bar: Report, camera: Camera | None) -> Report:
    """Tell the bar of each step, and let the camera take it."""

    def step(count: int, total: int) -> None:
        bar(count, total)
        if camera:
            camera(count, total)

    return step


def _rope(lift: Lift) -> CompensationRope:
    """The rope of a lift that is stepped in this process."""
    rope = lift.participants[-1]
    if not isinstance(rope, DirectParticipant) or not isinstance(rope.simulator, RopeSimulator):
        raise TypeError("an FMU does not show the rope's shape")
    return rope.simulator.rope


def _require_files(request: Request) -> None:
    """Refuse files that could not be written, before the long computation."""
    for path, kind in ((request.out, None), (request.plot, "picture"), (request.report, "page")):
        if path:
            require_writable(path, kind)


def _model(request: Request) -> tuple[RopeModel, dict[str, dict[str, Any]]]:
    """The model with its changes, and the changes that concern the drive, by table and key."""
    own, drive = {}, dict[str, dict[str, Any]]()
    for key, value in assignments(request.changes).items():
        table, _, name = key.partition(".")
        if table in Drive.model_fields and table not in RopeModel.model_fields:
            drive.setdefault(table, {})[name] = value
        else:
            own[key] = value
    return with_changes(load(model_path(request.model)), own, "--set"), drive


def _lift(
    request: Request, model: RopeModel, drive_changes: dict[str, dict[str, Any]], measured: Run | None
) -> tuple[AbstractContextManager[Lift], float]:
    """The lift to simulate and how long a trip takes it [s]; an FMU shows no shapes, so a report needs the models themselves."""
    direct = request.direct or request.report is not None
    if measured:
        return prescribed(model, measured.trips, direct), measured.end
    drive = _drive(request, model, drive_changes)
    return driven(model, drive, direct), first_trajectory(drive).end_time + SETTLE


def _drive(request: Request, model: RopeModel, changes: dict[str, dict[str, Any]]) -> Drive:
    """The drive of the named file or the preset's own, in the model's shaft, on the trip asked for."""
    motion, height = request.motion, model.shaft.height
    trip = {
        "start_position": 0.0 if motion.start is None else motion.start,
        "destination": height if motion.end is None else motion.end,
    }
    asked = {"shaft": {"height": height, "gravity": model.shaft.gravity}, "profile": dict(motion.profile or {}), "trip": trip}
    merged = {table: asked.get(table, {}) | changes.get(table, {}) for table in {*asked, *changes}}
    return load_drive(motion.drive or drive_path(request.model), merged)


@contextmanager
def _progress_bar() -> Iterator[Report]:
    """A bar on the terminal; nothing where standard error is none."""
    console = Console(file=sys.stderr)
    parts = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    # An FMU's messages on standard error are caught while it is called, so the bar leaves the streams alone.
    bar = Progress(*parts, console=console, transient=True, redirect_stdout=False, redirect_stderr=False)
    bar.disable = not console.is_terminal
    with bar:
        task = bar.add_task("settling the rope", total=None)
        yield lambda count, total: bar.update(task, completed=count, total=total, description="simulating")


def _write(request: Request, simulated: Simulated, measured: Run | None) -> None:
    if request.out:
        simulated.to_csv(request.out)
    if request.plot:
        from .plot import save_trip

        save_trip(request.plot, simulated, measured)


def _print(request: Request, simulated: Simulated) -> None:
    lines = summary(simulated)
    lines += [("written", str(path)) for path in (request.out, request.plot, request.report) if path]
    width = max(len(name) for name, _ in lines)
    sys.stdout.write("".join(f"{name:<{width}}  {text}\n" for name, text in lines))
