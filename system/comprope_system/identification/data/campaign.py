"""Reading of measurement campaigns: a folder with campaign.toml, a model file and one CSV file for each run.

All files are read and checked before an error is raised, so that it names every problem of all files.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from comprope import consent
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import load, with_changes

from ...measurements.campaign_file import CampaignFile, Channel, RunSpec, Tolerance, read_campaign_file
from ...measurements.motion.anchoring import Landings
from ...measurements.runs.end_motions import EndMotions, EndSignals, recover_ends
from ...measurements.runs.run_readings import run_problems
from ...measurements.runs.run_table import RunTable, read_run_table
from ...measurements.units import UNITS
from ...presets.inputs import require_still_building
from .car_direction import mirrored_car
from .channel_noise import ChannelNoise, channel_noise
from .runs import Run

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Campaign:
    """Campaign: the model under test, channels by column, and runs."""

    name: str
    folder: Path
    model: RopeModel
    model_path: Path
    channels: dict[str, Channel]
    runs: tuple[Run, ...]
    notes: tuple[str, ...] = field(default=())
    tolerances: Mapping[str, Tolerance | Literal["fixed"]] = field(default_factory=dict)

    @cached_property
    def noise(self) -> dict[str, ChannelNoise]:
        """Noise of each channel, by column."""
        return {column: channel_noise(channel, self.runs) for column, channel in self.channels.items()}

    def of_role(self, role: str) -> tuple[Run, ...]:
        """The runs of one role, "fit" or "validate"."""
        return tuple(run for run in self.runs if run.role == role)


def load_campaign(folder: str | Path) -> Campaign:
    """Campaign in a folder, or described by a file; raises `InputError` with one line for each problem of its files."""
    path = campaign_path(folder)
    described = read_campaign_file(path)
    found: list[str] = []
    model = _collect(found, lambda: require_still_building(load(path.parent / described.model), "a campaign"))
    found += channel_problems(path, described, model)
    runs = [_collect(found, lambda one=one: read_run(path, one, described, model)) for one in described.runs]
    if not any(one.role == "fit" for one in described.runs):
        found.append(f'{path}: runs: at least one with role = "fit" is needed')
    fit = [run for run in runs if run is not None and run.role == "fit"]
    if not found and not any(np.isfinite(value).any() for run in fit for value in run.values.values()):
        found.append(f"{path}: no channel has values in a fit run")
    if found or model is None:
        raise InputError("\n".join(found))
    channels = {one.column: one for one in described.channels}
    complete = tuple(run for run in runs if run is not None)
    return Campaign(
        described.name, path.parent, model, path.parent / described.model, channels, complete, tolerances=described.plant
    )


def with_model(campaign: Campaign, path: str | Path) -> Campaign:
    """The campaign with the model of another file; raises `InputError` if that cannot be read or lacks a sensor."""
    model = require_still_building(load(path), "a campaign")
    known = [sensor.name for sensor in model.sensors]
    missing = sorted({one.sensor for one in campaign.channels.values() if one.sensor} - set(known))
    if missing:
        raise InputError(f"{path}: lacks the sensor {', '.join(missing)} of the campaign; it has {', '.join(known) or 'none'}")
    return replace(campaign, model=model, model_path=Path(path))


def campaign_path(folder: str | Path) -> Path:
    """The campaign.toml of a folder, or the file itself."""
    path = Path(folder)
    return path / "campaign.toml" if path.is_dir() or not path.suffix else path


def _collect(problems_found: list[str], make: Any) -> Any:
    """Result of `make`; None if it raises `InputError`, whose lines are appended to `problems_found`."""
    try:
        return make()
    except InputError as error:
        problems_found += str(error).splitlines()
        return None


def channel_problems(path: Path, described: CampaignFile, model: RopeModel | None) -> list[str]:
    """Sentences about channels that are described twice, or with a unit, sensor or run's entry that there is not."""
    found, names = [], [one.column for one in described.channels]
    found += [f"{path}: channels: column {name} is described twice" for name in sorted({n for n in names if names.count(n) > 1})]
    found += [f"{path}: {line}" for line in run_problems(described)]
    sensors = [sensor.name for sensor in model.sensors] if model else []
    for k, one in enumerate(described.channels, 1):
        where = f"{path}: channels[{k}]"
        if one.unit not in UNITS[one.quantity]:
            found.append(f'{where}.unit = "{one.unit}": for {one.quantity} {", ".join(UNITS[one.quantity])} are accepted')
        if model and one.quantity == "lateral_displacement" and one.sensor not in sensors:
            found.append(
                f'{where}.sensor = "{one.sensor}": a sensor of the model is accepted: {", ".join(sensors) or "it has none"}'
            )
    return found


def read_run(path: Path, spec: RunSpec, described: CampaignFile, model: RopeModel | None) -> Run:
    """The run `spec` of a campaign.toml at `path`; raises `InputError` with one line for each problem of its files."""
    file = path.parent / spec.file
    found: list[str] = []
    changed = _collect(found, lambda: with_changes(model, spec.set, f"{path}: {spec.file}")) if model else None
    height = (changed or model).shaft.height if model else float("inf")
    within = None if consent.outside_given() else path.parent
    table = _collect(found, lambda: read_run_table(path.parent, spec, described, height, within))
    ends = _collect(found, lambda: _ends(table, spec, described, height, file)) if table and model else None
    if ends and table and model:
        trips = (ends.car, ends.counterweight)
        sentence = mirrored_car(changed or model, described.channels, table.values, trips, table.time)
        found += [f"{file}: {sentence}"] if sentence else []
    if found or ends is None or table is None:
        raise InputError("\n".join(found))
    notes = tuple(f"{spec.file}: {one}" for one in (*table.remarks, *ends.remarks))
    position = ends.car.position(table.time)
    run = Run(
        spec.file, spec.role, dict(spec.set), table.time, position, ends.car, ends.counterweight, table.values, notes,
        table.sampled, ends.lateral, table.started,
    )  # fmt: skip
    return _without_unseen_rest(run, described)


def _ends(table: RunTable, spec: RunSpec, described: CampaignFile, height: float, file: Path) -> EndMotions:
    """The motions of the rope's ends in a run."""
    signals = EndSignals(table.car, table.counterweight, table.lateral)
    return recover_ends(signals, height, spec.motion or described.motion, Landings(spec.car_start, spec.car_end), str(file))


def _without_unseen_rest(run: Run, described: CampaignFile) -> Run:
    """The run without its channels relative to rest that show nothing before the trip, with a remark for each."""
    rested = [one.column for one in described.channels if one.reference == "rest" and one.column in run.values]
    relative = [column for column in rested if np.isfinite(run.values[column]).any()]
    unseen = [column for column in relative if not np.isfinite(run.values[column][run.rest]).any()]
    if not unseen:
        return run
    empty = {column: np.full(len(run.time), np.nan) for column in unseen}
    why = 'shows nothing before the trip, but has reference = "rest"; left out of this run'
    return replace(run, values=run.values | empty, notes=(*run.notes, *(f"{run.file}: {column} {why}" for column in unseen)))
