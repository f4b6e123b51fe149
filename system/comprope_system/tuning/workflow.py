"""The public function `comprope_system.tune`: servo gains, every trip, and one controller for all trips."""

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from comprope.drive.parameters import Drive
from comprope.errors import InputError
from comprope.rope.effects import RopeModel

from ..parallel.executors import workers
from ..parallel.progress import Progress, no_progress
from ..parallel.sweep import sweep, values
from ..presets.inputs import DriveInput, ModelInput, model_name, read_drive, read_model, require_still_building
from ..presets.overrides import Changes
from ..vibration.reduced_model.calibration import calibrated_string
from ..vibration.reduced_model.state_space import as_json, rope_state_space
from .result import TuningResult
from .search.profile_families import Route
from .search.servo_gains import Gains, best_gains, loop_margins
from .shared_controller import shared_controller, shared_controller_json
from .task import Task, as_case, periods
from .trip_tuning import drive_of, fmu_case, tuned_trip

TRIPS = ((0.0, 0.04), (0.0, 0.11), (0.0, 0.3), (0.0, 1.0), (1.0, 0.85), (0.5, 0.6))  # of the shaft's height
POSITIONS = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)  # of the car over the shaft's height, of the state-space models
ROPE_KEYS = ("model", "way")  # of a trip's case, all that its swing depends on beside the drive
SHORTEST, MAX_TIME_FACTOR = 1.0, 5.0  # travel times over the present one
LEAST_DISTANCE = 0.5  # m between the ends of a trip


@dataclass(frozen=True)
class TuningOptions:
    """What is tuned, and what counts.

    `trips` are pairs (from, to) of heights [m] or texts "FROM:TO", by default six; `travel_times` are those of the front over
    the present one. The drive chosen for a trip takes `extra_time` (share) more than now, or is the fastest that swings less than
    `swing_limit` [m] if there is one. `residual_weight` from 0 to 1 is the weight of the swing after the trip beside that during
    it; `mass_spread` is the share by which the sheave may be lighter or heavier.
    """

    trips: Sequence[tuple[float, float] | str] = ()
    travel_times: Sequence[float] = (1.05, 1.1, 1.2, 1.35, 1.5)
    extra_time: float = 0.1
    swing_limit: float | None = None
    residual_weight: float = 0.5
    mass_spread: float = 0.0


def tune(
    model: ModelInput,
    options: TuningOptions | None = None,
    *,
    drive: DriveInput | None = None,
    changes: Changes | None = None,
    checkpoint: str | Path | None = None,
    executor: Executor | str | None = None,
    jobs: int | None = 1,
    progress: Progress = no_progress,
) -> TuningResult:
    """Choose profile, shaper and servo gains: least swing of the rope for a travel time, or least time for a swing.

    `model` is a model file, a preset's name or a `RopeModel`; `drive` the present drive, whose limits are kept, by default the
    preset's own; `changes` are values by key. Results go into the file `checkpoint` as they come and are taken over from it.
    Runs on `executor` (of concurrent.futures, or "dask://HOST:PORT"), else on `jobs` processes, 1 being this one and None one for
    each core. Raises `InputError` for bad input, `SimulationError` where a trip cannot be simulated.
    """
    options = options or TuningOptions()
    changed = require_still_building(read_model(model, changes), "tuning")
    present = present_drive(drive, model, changed)
    trips, factors = read_trips(options.trips, changed.shaft.height), _factors(options.travel_times)
    rope = calibrated_string(changed)
    before, after = loop_margins(present), best_gains(present)
    tasks = [_task(options, changed, present, after, trip, factors) for trip in trips]
    store = Path(checkpoint) if checkpoint else None
    with workers(jobs, executor) as chosen:
        found = values(sweep(tuned_trip, [as_case(task) for task in tasks], chosen, store, "tuning trips", progress))
        common = shared_controller(tasks, options.extra_time)
        cases = [_shared_case(task, common.drive) for task in tasks] if common else []
        full = values(sweep(fmu_case, cases, chosen, store, "one controller", progress))
    settings = {
        "model": model_name(model), "extra": options.extra_time, "limit": _millimetres(options.swing_limit),
        "weight": options.residual_weight, "spread": options.mass_spread,
        "rope": {"held": rope.offset_coefficients, "offset": rope.offset},
    }  # fmt: skip
    return TuningResult(
        settings, {"present": before.to_json(), "chosen": after.to_json()}, tuple(found),
        shared_controller_json(common, full) if common else None,
        _drives(tasks, found), common.drive if common else None, _rope_models(tasks[0]),
    )  # fmt: skip


def present_drive(drive: DriveInput | None, model: ModelInput, changed: RopeModel) -> Drive:
    """The present drive in the model's shaft, without a trip of its own."""
    shaft = {"height": changed.shaft.height, "gravity": changed.shaft.gravity}
    trip = {"start_position": 0.0, "destination": changed.shaft.height}
    return read_drive(drive, model, {"shaft": shaft, "trip": trip})


def read_trips(trips: Sequence[tuple[float, float] | str], height: float) -> list[tuple[float, float]]:
    """Trips as pairs of heights [m], from pairs or texts such as `0:22`; raises `InputError` naming every one that is none."""
    if not trips:
        return [(start * height, end * height) for start, end in TRIPS]
    found, problems = [], []
    for given in trips:
        trip = _heights(given) if isinstance(given, str) else given
        if not all(0.0 <= one <= height for one in trip) or abs(trip[0] - trip[1]) < LEAST_DISTANCE:
            name = f"--trip {given}" if isinstance(given, str) else f"trip {given[0]}:{given[1]}"
            problems.append(f"{name}: two heights FROM:TO from 0 to {height:g} m, half a metre apart or more, are accepted")
        found.append(trip)
    if problems:
        raise InputError("\n".join(problems))
    return found


def _heights(text: str) -> tuple[float, float]:
    start, _, end = text.partition(":")
    try:
        return float(start), float(end)
    except ValueError:
        return math.nan, math.nan


def _factors(times: Sequence[float]) -> list[float]:
    """Travel times over the present one in rising order; raises `InputError` if one is out of range."""
    if wrong := [one for one in times if not SHORTEST <= one <= MAX_TIME_FACTOR]:
        raise InputError(f"travel_times: {wrong[0]}: numbers from {SHORTEST:g} to {MAX_TIME_FACTOR:g} are accepted")
    return sorted(times)


def _millimetres(length: float | None) -> float | None:
    """A length [m] in mm, rounded to the micrometre's thousandth so that 0.0021 m is 2.1 mm."""
    return None if length is None else round(1e3 * length, 6)


def _task(
    options: TuningOptions,
    model: RopeModel,
    present: Drive,
    gains: Gains,
    trip: tuple[float, float],
    factors: Sequence[float],
) -> Task:
    bare = model.model_copy(update={"sensors": ()})
    drive = present.model_copy(update={"servo": gains.servo})
    route = Route(*trip, periods(model))
    weights = options.residual_weight, options.mass_spread
    return Task(bare, drive, present, route, factors, *weights, 1.0 + options.extra_time, options.swing_limit)


def _shared_case(task: Task, drive: Drive) -> dict[str, Any]:
    """One trip of the controller for all trips, whose swing its FMUs give."""
    return {"drive": drive.model_dump()} | {key: value for key, value in as_case(task).items() if key in ROPE_KEYS}


def _drives(tasks: Sequence[Task], trips: Sequence[Mapping[str, Any]]) -> dict[str, tuple[Drive, str]]:
    """The tuned drive of each trip and the heading of its file, by the trip as part of a file's name: `0_22`."""
    found = {}
    for task, trip in zip(tasks, trips, strict=True):
        if trip["installed"]:
            point = next(one for one in trip["points"] if one["factor"] == trip["installed"]["factor"])
            heading = (
                f"Tuned for the trip from {trip['origin']:g} to {trip['destination']:g} m: {point['tuned']['kind']}, "
                f"{point['tuned']['time']:.2f} s."
            )
            found[f"{trip['origin']:g}_{trip['destination']:g}"] = drive_of(task, point["tuned"]), heading
    return found


def _rope_models(task: Task) -> dict[str, Any]:
    """State-space models of the rope by the car's position [m]."""
    positions = [share * task.model.shaft.height for share in POSITIONS]
    return {f"{car:g}": as_json(rope_state_space(task.reduced_model(), car)) for car in positions}
