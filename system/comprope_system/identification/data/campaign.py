"""Reading of measurement campaigns: a folder with campaign.toml, a model file and one CSV file for each run.

All files are read and checked before an error is raised, so that it names every problem of all files.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from comprope.errors import InputError
from comprope.quantities import Component
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import load, read_toml, with_changes
from comprope.validation_messages import validation_problems

from ...measurements import Trip
from ...measurements.run_table import UNITS, read_table, read_trips
from ..settings import TRIP_PHASES

Floats = NDArray[np.float64]
Quantity = Literal[
    "lateral_displacement", "sheave_displacement", "sheave_angular_velocity", "sheave_force",
    "car_end_tension", "counterweight_end_tension",
]  # fmt: skip


class Channel(Component):
    """Measured channel: a column of the CSV files with its quantity, unit, reference and noise."""

    column: str = Field(description="the column's name in the CSV header")
    quantity: Quantity = Field(description="what is measured")
    sensor: str | None = Field(None, description="for lateral_displacement: a sensor of the model")
    unit: str = Field(description="unit of the column and of its noise")
    reference: Literal["rest", "absolute"] = Field("absolute", description="value less its mean before the trip, or the value")
    noise: float | None = Field(None, ge=0.0, description="one standard deviation of the noise, in the unit of the column")

    @property
    def scale(self) -> float:
        """SI units per unit of the column."""
        return UNITS[self.quantity][self.unit]


class RunSpec(Component):
    """Entry of a run in campaign.toml: its file, its role, and the parameters that differ from the model file."""

    file: str = Field(description="the CSV file, relative to campaign.toml")
    role: Literal["fit", "validate"] = Field("fit", description="validate: never used for fitting or ranking")
    set: dict[str, float | str] = Field(default_factory=dict, description='changes of the model, e.g. { "sheave.mass" = 120.0 }')


class CampaignFile(Component):
    """Content of campaign.toml."""

    name: str = Field(description="name of the campaign")
    model: str = Field(description="the model file, relative to campaign.toml")
    channels: tuple[Channel, ...] = Field(description="the channels, at least one")
    runs: tuple[RunSpec, ...] = Field(description="the runs, at least one")


@dataclass(frozen=True)
class Run:
    """Measured run in SI units: `values[column]` (n,) at `time` (n,) [s], NaN where a sample is missing.

    `changes` are the parameters that differ from the model file; `trip` and `counterweight` are smooth trajectories fitted to
    the measured positions; `notes` are messages about the data.
    """

    file: str
    role: str
    changes: dict[str, Any]
    time: Floats
    car_position: Floats
    trip: Trip
    counterweight: Trip
    values: dict[str, Floats]
    notes: tuple[str, ...] = ()

    @property
    def rest(self) -> NDArray[np.bool_]:
        """Samples (n,) before the trip."""
        return np.asarray(self.time <= max(self.trip.rest_before, self.time[0] + TRIP_PHASES.rest_duration))


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

    def of_role(self, role: str) -> tuple[Run, ...]:
        """The runs of one role, "fit" or "validate"."""
        return tuple(run for run in self.runs if run.role == role)


def load_campaign(folder: str | Path) -> Campaign:
    """Campaign in a folder, or described by a file; raises `InputError` with one line for each problem of its files."""
    path = Path(folder)
    path = path / "campaign.toml" if path.is_dir() or not path.suffix else path
    described = _campaign_file(path)
    found: list[str] = []
    model = _collect(found, lambda: load(path.parent / described.model))
    found += _channel_problems(path, described, model)
    runs = [_collect(found, lambda one=one: _run(path, one, described, model)) for one in described.runs]
    if not any(one.role == "fit" for one in described.runs):
        found.append(f'{path}: runs: at least one with role = "fit" is needed')
    if found or model is None:
        raise InputError("\n".join(found))
    channels = {one.column: one for one in described.channels}
    complete = tuple(run for run in runs if run is not None)
    return Campaign(described.name, path.parent, model, path.parent / described.model, channels, complete)


def _collect(problems_found: list[str], make: Any) -> Any:
    """Result of `make`; None if it raises `InputError`, whose lines are appended to `problems_found`."""
    try:
        return make()
    except InputError as error:
        problems_found += str(error).splitlines()
        return None


def _campaign_file(path: Path) -> CampaignFile:
    try:
        table = {key: tuple(value) if isinstance(value, list) else value for key, value in read_toml(path).items()}
        return CampaignFile.model_validate(table)
    except ValidationError as error:
        raise InputError("\n".join(f"{path}: {line}" for line in validation_problems(error, CampaignFile))) from None


def _channel_problems(path: Path, described: CampaignFile, model: RopeModel | None) -> list[str]:
    found, names = [], [one.column for one in described.channels]
    found += [f"{path}: channels: column {name} is described twice" for name in sorted({n for n in names if names.count(n) > 1})]
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


def _run(path: Path, spec: RunSpec, described: CampaignFile, model: RopeModel | None) -> Run:
    file = path.parent / spec.file
    found: list[str] = []
    changed = _collect(found, lambda: with_changes(model, spec.set, f"{path}: {spec.file}")) if model else None
    columns = ["time", "car_position", *(one.column for one in described.channels)]
    table = _collect(found, lambda: read_table(file, columns))
    height = (changed or model).shaft.height if model else 0.0
    trips = _collect(found, lambda: read_trips(file, table, height)) if table is not None and model else None
    if found or trips is None or table is None:
        raise InputError("\n".join(found))
    usable = [one for one in described.channels if one.unit in UNITS[one.quantity]]
    values = {one.column: table[one.column].to_numpy(float) * one.scale for one in usable}
    time, car = table["time"].to_numpy(float), table["car_position"].to_numpy(float)
    trip, counterweight = trips
    return Run(spec.file, spec.role, dict(spec.set), time, car, trip, counterweight, values)
