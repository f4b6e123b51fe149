"""What `comprope design` does: the least sheave, sensor positions, resonances; a page, pictures and a result file."""

import json
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from comprope.atomic_files import atomic_write, require_writable
from comprope.drive.parameters import Profile
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table, load, with_changes

from ..parallel.executors import workers
from ..parallel.sweep import sweep, values
from ..presets import drive_path, model_path
from ..presets.overrides import assignments
from ..reduced_model.swing import SIDES, tail
from ..report.page import save_page, save_pictures
from ..simulation.elevator import load_drive
from ..studies.design import TOLERANCE
from ..tuning.task import case_of
from . import report
from .building_sway import Sway, parked
from .sensor_placement import choose
from .trip_envelopes import envelopes, floors, full_of_mass, of_mass, pairs, rope_of_mass

PAGE, RESULT, STORE = "design.html", "result.json", "runs.jsonl"
MASSES = np.geomspace(0.35, 8.0, 22)  # of the model's own sheave
LOWEST = 1.5  # m above the axle: where the lowest sensor may be
BINS = 60  # heights that a sensor may have, on each side
WORST = 60  # trips that sensors are chosen for: those that swing most, during and after
TRIES = 12  # of a full model's search for the mass


@dataclass(frozen=True)
class Request:
    """What a user asks for; limits and the sway's amplitude are in mm, its period and duration in s."""

    model: str
    drive: Path | None
    limit: float
    floors: int
    sway_amplitude: float
    sway_period: float | None
    sway_duration: float
    sway_limit: float | None
    sensors: int
    changes: tuple[str, ...]
    out: Path
    json: Path | None = None
    jobs: int | None = None
    executor: str | None = None

    @property
    def sway(self) -> Sway | None:
        """The building's sway, if any is asked for."""
        return Sway(1e-3 * self.sway_amplitude, self.sway_period, self.sway_duration) if self.sway_period else None


def run(request: Request) -> dict[str, Any]:
    """Design, write all files and print a summary; raises `InputError` for bad input or a limit that no sheave keeps."""
    for path in (request.out / PAGE, *([request.json] if request.json else [])):
        require_writable(path)
    model = with_changes(load(model_path(request.model)), assignments(request.changes), "--set").model_copy(
        update={"sensors": ()}
    )
    height = model.shaft.height
    tables = {"shaft": {"height": height}, "trip": {"start_position": 0.0, "destination": height}}
    profile = load_drive(request.drive or drive_path(request.model), tables).profile
    sway = request.sway
    base: dict[str, Any] = {"model": as_table(model), "profile": profile.model_dump(), "floors": request.floors}
    base |= {"sway": sway.__dict__ if sway else None}
    with workers(request.jobs, request.executor) as executor:
        cases = [base | {"mass": float(mass)} for mass in MASSES * model.sheave.mass if _wraps(model, float(mass))]
        scanned = values(sweep(of_mass, cases, executor, request.out / STORE, "masses"))
        mass = _least(scanned, "swing", "--limit", request.limit)
        if sway and request.sway_limit is not None:
            mass = max(mass, _least(scanned, "sway", "--sway-limit", request.sway_limit))
        least, runs = _on_full_model(base, scanned, mass, 1e-3 * request.limit, executor, request.out / STORE)
    chosen = rope_of_mass(model, least)
    result = {
        "model": request.model, "limit": 1e-3 * request.limit, "sway_limit": request.sway_limit,
        "floors": request.floors, "sway": base["sway"],
        "own_mass": model.sheave.mass, "mass_small": mass, "mass": least, "scanned": scanned, "full": runs,
        "sensors": _sensors(chosen, profile, request, sway),
    }  # fmt: skip
    _write(request, result, model, chosen, profile)
    return result


def _wraps(model: RopeModel, mass: float) -> bool:
    """Whether the rope wraps a sheave of that mass [kg] well enough for the small rope."""
    weight = 0.5 * model.shaft.gravity * mass
    return weight > model.rope.bending_stiffness / model.sheave.radius**2


def _least(scanned: Sequence[Mapping[str, Any]], what: str, option: str, limit: float) -> float:
    """The least mass from which on a limit [mm] is kept by every heavier one scanned, between two of them by a power law."""
    worst = 1e3 * np.array([one[what] for one in scanned])
    masses = np.array([one["mass"] for one in scanned])
    above = np.flatnonzero(worst > limit)
    if not above.size:
        return float(masses[0])
    k = int(above[-1])
    if k + 1 == len(masses):
        raise InputError(
            f"{option} {limit:g}: {worst[-1]:.2f} mm or more is accepted; that is the swing even with a sheave of "
            f"{masses[-1]:.0f} kg"
        )
    share = np.log(worst[k] / limit) / np.log(worst[k] / worst[k + 1])
    return float(masses[k] * (masses[k + 1] / masses[k]) ** share)


def _on_full_model(
    base: Mapping[str, Any],
    scanned: Sequence[Mapping[str, Any]],
    mass: float,
    limit: float,
    executor: Executor | None,
    store: Path,
) -> tuple[float, list[list[float]]]:
    """The least mass at which the worst trip keeps the limit on the full model, from the small rope's up; and all runs."""
    near = min(scanned, key=lambda one: abs(one["mass"] - mass))
    runs: list[list[float]] = []

    def swing(at: float) -> float:
        case = dict(base) | {"mass": at, "trip": near["trip"]}
        runs.append([at, values(sweep(full_of_mass, [case], executor, store, "full model"))[0]])
        return float(runs[-1][1])

    high, low, heaviest = mass, mass, scanned[-1]["mass"]
    while (now := swing(high)) > limit:
        low, high = high, high * max(1.01, now / limit)
        if high > heaviest:
            raise InputError(
                f"--limit {1e3 * limit:g}: {1e3 * now:.2f} mm or more is accepted; that is the swing on the full model with a "
                f"sheave of {low:.0f} kg"
            )
    while high - low > TOLERANCE * high and len(runs) < TRIES:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if swing(middle) <= limit else (middle, high)
    return high, sorted(runs)


def _sensors(model: RopeModel, profile: Profile, request: Request, sway: Sway | None) -> dict[str, Any]:
    """The heights [m] from which a few sensors see most of every large swing."""
    small, heights = case_of(model), floors(model.shaft.height, request.floors)
    spots = np.linspace(LOWEST - model.shaft.pit, model.shaft.height, BINS)
    occasions: tuple[list[Any], list[Any]] = ([], [])  # during and after trips
    for trip in pairs(heights):
        for kind, seen in zip(occasions, envelopes(small, profile, trip, tail(model, trip[1]), spots), strict=True):
            kind += [np.concatenate([seen[one], seen[other]]) for one, other in (tuple(SIDES), tuple(SIDES)[::-1])]
    largest = [one for kind in occasions for one in sorted(kind, key=lambda each: -float(each.max()))[: 2 * WORST]]
    found = choose(np.array(largest), request.sensors)
    places = [{"side": "car" if k < BINS else "counterweight", "height": float(spots[k % BINS])} for k in found.places]
    profile_of = parked(small, sway, float(heights[0])) if sway else {}
    return {
        "places": places, "share": found.share, "heights": spots.tolist(), "seen": np.max(largest, axis=0).tolist(),
        "sway_seen": {side: one.tolist() for side, one in profile_of.items()},
    }  # fmt: skip


def _write(request: Request, result: Mapping[str, Any], model: RopeModel, chosen: RopeModel, profile: Profile) -> None:
    for path in (request.out / RESULT, request.json):
        if path:
            with atomic_write(path) as temporary:
                temporary.write_text(json.dumps(result), encoding="utf-8")
    sections = report.sections(result, model, chosen, profile)
    save_pictures(request.out, sections)
    save_page(request.out / PAGE, report.TITLE, report.LEAD, sections)
    sys.stdout.write("".join(f"{line}\n" for line in report.summary(result)))
    sys.stdout.write(f"written {request.out / PAGE}\n")
