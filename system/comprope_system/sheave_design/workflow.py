"""The public function `comprope_system.design`: smallest sheave mass, sensor heights, natural periods against trips and sway."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from comprope.drive.parameters import Profile
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table

from ..parallel.executors import workers
from ..parallel.progress import Progress, no_progress
from ..parallel.sweep import sweep, values
from ..presets.inputs import DriveInput, ModelInput, model_name, read_drive, read_model, require_still_building
from ..presets.overrides import Changes
from ..simulation.trips.clearance import known_wall
from ..studies.paper.design import TOLERANCE
from ..tuning.task import reduced_model_of
from ..vibration.reduced_model.swing import SIDES, observation_time
from .building_sway import BuildingSway, parked_departures
from .clearance_cases import clearances
from .result import DesignResult
from .rope_sharing import RopeSet, share_sheave
from .sensor_placement import choose_sensors
from .stop_cases import stop_case, stop_cases
from .trip_envelopes import envelopes, floor_heights, full_model_case, mass_case, model_with_sheave, trips_between

MASS_RATIOS = np.geomspace(0.35, 8.0, 22)  # of the model's own sheave
LOWEST = 1.5  # m above the axle: where the lowest sensor may be
SENSOR_POSITIONS = 60  # heights that a sensor may have, on each side
SELECTED_TRIPS = 60  # trips that sensors are chosen for: those that swing most, during and after
MAX_RUNS = 12  # of a full model's search for the mass


@dataclass(frozen=True)
class DesignOptions:
    """Requirements of the design.

    `swing_limit` [m] is the largest swing during and after a trip, `floors` the number of evenly spaced floors between which all
    trips count, `sway` that of the building, `sway_limit` [m] the largest swing in it, None if it is only computed; `sensors` is
    the number of sensors to place. With `stops` the new sheave goes through stops at every floor as well. With the distance of
    the shaft's `wall` [m] the clearance is computed, in stops too. `ropes` are those of the sheave, if they differ.
    """

    swing_limit: float = 0.010
    floors: int = 11
    sway: BuildingSway | None = None
    sway_limit: float | None = None
    sensors: int = 4
    stops: bool = False
    wall: float | None = None
    ropes: RopeSet | None = None


@dataclass(frozen=True)
class _Sweeps:
    """Execution of sweeps: executor, results file, and progress callback."""

    executor: Executor | None
    store: Path | None
    progress: Progress

    def values(self, task: Any, cases: Sequence[Mapping[str, Any]], label: str) -> list[Any]:
        """`task` of each case."""
        return values(sweep(task, cases, self.executor, self.store, label, self.progress))


def design(
    model: ModelInput,
    options: DesignOptions | None = None,
    *,
    drive: DriveInput | None = None,
    changes: Changes | None = None,
    checkpoint: str | Path | None = None,
    executor: Executor | str | None = None,
    jobs: int | None = 1,
    progress: Progress = no_progress,
) -> DesignResult:
    """Compute the smallest sheave mass for a limit of the swing on all trips and under building sway, and sensor heights.

    `model` is a model file, a preset's name or a `RopeModel`; `drive` moves the car, by default the preset's own; `changes` are
    values by key. Results go into the file `checkpoint` as they come and are taken over from it. Runs on `executor` (of
    concurrent.futures, or "dask://HOST:PORT"), else on `jobs` processes, 1 being this one and None one for each core. Raises
    `InputError` for bad input or a limit that no sheave keeps.
    """
    options = options or DesignOptions()
    if options.wall is not None:
        known_wall(read_model(model, changes), options.wall)
    given = require_still_building(read_model(model, changes), "the design").model_copy(update={"sensors": ()})
    height, sway = given.shaft.height, options.sway
    tables = {"shaft": {"height": height}, "trip": {"start_position": 0.0, "destination": height}}
    profile = read_drive(drive, model, tables).profile
    base: dict[str, Any] = {"model": as_table(given), "profile": profile.model_dump(), "floors": options.floors}
    base["sway"] = vars(sway) if sway else None
    with workers(jobs, executor) as chosen:
        sweeps = _Sweeps(chosen, Path(checkpoint) if checkpoint else None, progress)
        cases = [base | {"mass": float(mass)} for mass in MASS_RATIOS * given.sheave.mass if _wraps(given, float(mass))]
        scanned = sweeps.values(mass_case, cases, "masses")
        mass = _least_mass(scanned, "swing", "swing_limit", _millimetres(options.swing_limit))
        if sway and options.sway_limit is not None:
            mass = max(mass, _least_mass(scanned, "sway", "sway_limit", _millimetres(options.sway_limit)))
        least, runs = _on_full_model(base, scanned, mass, options.swing_limit, sweeps)
        new_model = model_with_sheave(given, least)
        asked = stop_cases(new_model, profile, options.floors, options.wall) if options.stops else []
        stops = sweeps.values(stop_case, asked, "stops") if asked else []
    settings = {"model": model_name(model)} | _settings(options)
    sensors = _sensors(new_model, profile, options)
    worst = min(scanned, key=lambda one: abs(one["mass"] - least))
    beside = clearances(new_model, profile, worst, sway, options.wall) if options.wall is not None else []
    sharing = share_sheave(new_model, options.ropes) if options.ropes else None
    return DesignResult(
        settings, least, mass, tuple(scanned), tuple(runs), sensors, tuple(stops), given, new_model, profile, tuple(beside),
        sharing,
    )  # fmt: skip


def _settings(options: DesignOptions) -> dict[str, Any]:
    """The limits and floors of a design as its result states them."""
    return {
        "limit": options.swing_limit,
        "sway_limit": None if options.sway_limit is None else _millimetres(options.sway_limit),
        "floors": options.floors,
        "sway": vars(options.sway) if options.sway else None,
    }


def _millimetres(length: float) -> float:
    """A length [m] in mm, without the last digits that the factor leaves: 0.0021 m is 2.1 mm."""
    return round(1e3 * length, 6)


def _wraps(model: RopeModel, mass: float) -> bool:
    """Whether the rope wraps a sheave of this mass [kg] well enough for the reduced model."""
    weight = 0.5 * model.shaft.gravity * mass / model.sheave.ropes
    return weight > model.rope.bending_stiffness / model.sheave.radius**2


def _least_mass(scanned: Sequence[Mapping[str, Any]], what: str, option: str, limit: float) -> float:
    """The least mass from which on a limit [mm] is kept by every heavier one scanned, between two of them by a power law."""
    worst = 1e3 * np.array([one[what] for one in scanned])
    masses = np.array([one["mass"] for one in scanned])
    above = np.flatnonzero(worst > limit)
    if not above.size:
        return float(masses[0])
    k = int(above[-1])
    if k + 1 == len(masses):
        raise InputError(
            f"{option} = {limit:g} mm: {worst[-1]:.2f} mm or more is accepted; that is the swing even with a sheave of "
            f"{masses[-1]:.0f} kg"
        )
    share = np.log(worst[k] / limit) / np.log(worst[k] / worst[k + 1])
    return float(masses[k] * (masses[k + 1] / masses[k]) ** share)


def _on_full_model(
    base: Mapping[str, Any], scanned: Sequence[Mapping[str, Any]], mass: float, limit: float, sweeps: _Sweeps
) -> tuple[float, list[list[float]]]:
    """The least mass at which the worst trip keeps the limit on the full model, from the reduced model's up; and all runs."""
    near = min(scanned, key=lambda one: abs(one["mass"] - mass))
    runs: list[list[float]] = []

    def swing(at: float) -> float:
        case = dict(base) | {"mass": at, "trip": near["trip"]}
        runs.append([at, sweeps.values(full_model_case, [case], "full model")[0]])
        return float(runs[-1][1])

    high, low, heaviest = mass, mass, scanned[-1]["mass"]
    while (now := swing(high)) > limit:
        low, high = high, high * max(1.01, now / limit)
        if high > heaviest:
            raise InputError(
                f"swing_limit = {1e3 * limit:g} mm: {1e3 * now:.2f} mm or more is accepted; that is the swing on the full "
                f"model with a sheave of {low:.0f} kg"
            )
    while high - low > TOLERANCE * high and len(runs) < MAX_RUNS:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if swing(middle) <= limit else (middle, high)
    return high, sorted(runs)


def _sensors(model: RopeModel, profile: Profile, options: DesignOptions) -> dict[str, Any]:
    """Heights [m] at which a few sensors measure most of every large swing."""
    reduced, heights = reduced_model_of(model), floor_heights(model.shaft.height, options.floors)
    positions = np.linspace(LOWEST - model.shaft.pit, model.shaft.height, SENSOR_POSITIONS)
    occasions: tuple[list[Any], list[Any]] = ([], [])  # during and after trips
    for trip in trips_between(heights):
        for kind, departures in zip(
            occasions, envelopes(reduced, profile, trip, observation_time(model, trip[1]), positions), strict=True
        ):
            kind += [np.concatenate([departures[one], departures[other]]) for one, other in (tuple(SIDES), tuple(SIDES)[::-1])]
    largest = [one for kind in occasions for one in sorted(kind, key=lambda each: -float(each.max()))[: 2 * SELECTED_TRIPS]]
    found = choose_sensors(np.array(largest), options.sensors)
    places = [
        {"side": "car" if k < SENSOR_POSITIONS else "counterweight", "height": float(positions[k % SENSOR_POSITIONS])}
        for k in found.places
    ]
    profile_of = parked_departures(reduced, options.sway, float(heights[0])) if options.sway else {}
    return {
        "places": places, "share": found.share, "heights": positions.tolist(), "seen": np.max(largest, axis=0).tolist(),
        "sway_seen": {side: one.tolist() for side, one in profile_of.items()},
    }  # fmt: skip
