"""What `comprope tune` does: read, choose servo gains, tune every trip, choose one controller for all, write."""

import json
import math
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomli_w

from comprope.atomic_files import atomic_write, require_writable
from comprope.drive.parameters import Drive
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import load, with_changes

from ..parallel.executors import workers
from ..parallel.sweep import sweep, values
from ..presets import drive_path, model_path
from ..presets.overrides import assignments
from ..reduced_model.calibration import calibrated
from ..reduced_model.state_space import as_json, rope_model
from ..report.page import save_page, save_pictures
from ..simulation.elevator import load_drive
from . import report
from .search.profile_families import Way
from .search.servo_gains import Gains, best_gains, gains_of
from .shared_controller import Joint, joint, told
from .task import CHOSEN, Task, as_case, periods
from .trip_tuning import drive_of, installed_case, tuned_trip

PAGE, RESULT, STORE, MODELS, CONTROLLER = "tuning.html", "result.json", "runs.jsonl", "rope_models.json", "controller.drive.toml"
TRIPS = ((0.0, 0.04), (0.0, 0.11), (0.0, 0.3), (0.0, 1.0), (1.0, 0.85), (0.5, 0.6))  # of the shaft's height
SEEN = ("model", "way")  # of a trip's case, all that its swing depends on beside the drive
SHORTEST, LONGEST = 1.0, 5.0  # travel times over the present one


@dataclass(frozen=True)
class Request:
    """What a user asks for; `trips` are texts FROM:TO [m], `times` a text of factors, `limit` is in mm."""

    model: str
    drive: Path | None
    trips: Sequence[str]
    times: str
    extra: float
    limit: float | None
    weight: float
    spread: float
    changes: tuple[str, ...]
    out: Path
    json: Path | None = None
    jobs: int | None = None
    executor: str | None = None


def run(request: Request) -> dict[str, Any]:
    """Tune, write all files and print a summary; raises `InputError` for bad input."""
    for path in (request.out / PAGE, *([request.json] if request.json else [])):
        require_writable(path)
    model = with_changes(load(model_path(request.model)), assignments(request.changes), "--set")
    present = present_drive(request, model)
    trips, factors = read_trips(request.trips, model.shaft.height), read_times(request.times)
    rope = calibrated(model)
    before, after = gains_of(present), best_gains(present)
    tasks = [_task(request, model, present, after, trip, factors) for trip in trips]
    with workers(request.jobs, request.executor) as executor:
        found = values(sweep(tuned_trip, [as_case(task) for task in tasks], executor, request.out / STORE, "tuning trips"))
        common = joint(tasks, request.extra)
        shared = _installed(common, tasks, executor, request.out / STORE) if common else None
    result = {
        "model": request.model, "extra": request.extra, "limit": request.limit, "weight": request.weight,
        "spread": request.spread, "rope": {"held": rope.held, "offset": rope.offset},
        "servo": {"present": before.told(), "chosen": after.told()}, "trips": found, "controller": shared,
    }  # fmt: skip
    _write(request, result, tasks, common)
    return result


def present_drive(request: Request, model: RopeModel) -> Drive:
    """The present drive in the model's shaft, without a trip of its own."""
    shaft = {"height": model.shaft.height, "gravity": model.shaft.gravity}
    trip = {"start_position": 0.0, "destination": model.shaft.height}
    return load_drive(request.drive or drive_path(request.model), {"shaft": shaft, "trip": trip})


def read_trips(texts: Sequence[str], height: float) -> list[tuple[float, float]]:
    """Trips such as `0:22` [m]; raises `InputError` naming every one that is none."""
    if not texts:
        return [(start * height, end * height) for start, end in TRIPS]
    found, problems = [], []
    for text in texts:
        start, _, end = text.partition(":")
        try:
            trip = float(start), float(end)
        except ValueError:
            trip = math.nan, math.nan
        if not all(0.0 <= one <= height for one in trip) or abs(trip[0] - trip[1]) < 0.5:
            problems.append(
                f"--trip {text}: two heights FROM:TO from 0 to {height:g} m, half a metre apart or more, are accepted"
            )
        found.append(trip)
    if problems:
        raise InputError("\n".join(problems))
    return found


def read_times(text: str) -> list[float]:
    """Factors such as `1.05,1.2`; raises `InputError` if one is none."""
    try:
        found = sorted(float(one) for one in text.split(","))
    except ValueError:
        found = [math.nan]
    if not all(SHORTEST <= one <= LONGEST for one in found):
        raise InputError(f"--times {text}: numbers from {SHORTEST:g} to {LONGEST:g}, with commas between, are accepted")
    return found


def _task(
    request: Request, model: RopeModel, present: Drive, gains: Gains, trip: tuple[float, float], factors: Sequence[float]
) -> Task:
    bare = model.model_copy(update={"sensors": ()})
    drive = present.model_copy(update={"servo": gains.servo})
    limit = None if request.limit is None else 1e-3 * request.limit
    way = Way(*trip, periods(model))
    return Task(bare, drive, present, way, factors, request.weight, request.spread, 1.0 + request.extra, limit)


def _installed(common: Joint, tasks: Sequence[Task], executor: Executor | None, store: Path) -> dict[str, Any]:
    """The controller for all trips, with the swings of its FMUs."""
    cases = [
        {"drive": common.drive.model_dump()} | {key: value for key, value in as_case(task).items() if key in SEEN}
        for task in tasks
    ]
    return told(common, values(sweep(installed_case, cases, executor, store, "one controller")))


def _write(request: Request, result: Mapping[str, Any], tasks: Sequence[Task], common: Joint | None) -> None:
    out = request.out
    for task, trip in zip(tasks, result["trips"], strict=True):
        if trip["installed"]:
            point = next(one for one in trip["points"] if one["factor"] == trip["installed"]["factor"])
            save_drive(out / f"trip_{trip_name(trip)}.drive.toml", drive_of(task, point["tuned"]), _heading(trip, point))
    if common:
        save_drive(out / CONTROLLER, common.drive, f"One controller for all trips: {common.kind}.")
    models = {f"{car:g}": as_json(rope_model(tasks[0].case(), car)) for car in _positions(tasks[0].model.shaft.height)}
    for path, content in ((out / RESULT, result), (out / MODELS, models), (request.json, result)):
        if path:
            with atomic_write(path) as temporary:
                temporary.write_text(json.dumps(content), encoding="utf-8")
    sections = report.sections(result)
    save_pictures(out, sections)
    save_page(out / PAGE, report.TITLE, report.LEAD, sections)
    sys.stdout.write("".join(f"{line}\n" for line in report.summary(result)))
    sys.stdout.write(f"written {out / PAGE}\n")


def trip_name(trip: Mapping[str, Any]) -> str:
    """A trip as part of a file's name: `0_22`."""
    return f"{trip['origin']:g}_{trip['destination']:g}"


def save_drive(path: Path, drive: Drive, heading: str) -> None:
    """Write profile, curve, shaper and servo of a drive as a parameter file, whole or not at all."""
    table = drive.model_dump(include=CHOSEN)
    if not drive.curve.used:
        del table["curve"]
    with atomic_write(path) as temporary:
        temporary.write_text(f"# {heading}\n\n{tomli_w.dumps(table)}", encoding="utf-8", newline="\n")


def _heading(trip: Mapping[str, Any], point: Mapping[str, Any]) -> str:
    return (
        f"Tuned for the trip from {trip['origin']:g} to {trip['destination']:g} m: {point['tuned']['kind']}, "
        f"{point['tuned']['time']:.2f} s."
    )


def _positions(height: float) -> list[float]:
    return [share * height for share in (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)]
