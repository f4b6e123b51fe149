"""A measured run for the simulation to follow: how the car moved, and what the sensors saw.

The file `campaign.toml` beside a run, where there is one, tells units, references and what differs
from the model file in that run. Without it, columns with a sensor's name are lateral displacements in metres.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comprope.errors import InputError
from comprope.rope.modelfile import read_toml

from .trips import Trip, recover_trip

Floats = NDArray[np.float64]
UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}


@dataclass(frozen=True)
class Channel:
    """Lateral displacement measured at a sensor [m]; `from_rest`: less its mean before the trip."""

    time: Floats
    value: Floats
    from_rest: bool


@dataclass(frozen=True)
class Run:
    """A measured run: trips of "car" and "counterweight", channels by sensor, changes of the model, last time [s]."""

    trips: dict[str, Trip]
    channels: dict[str, Channel]
    changes: dict[str, Any]
    end: float


def read_run(path: Path, height: float, sensors: Sequence[str]) -> Run:
    """The run of a CSV file, in a shaft of this height [m]; raises `InputError` for what it lacks."""
    table = _table(path)
    time = table["time"].to_numpy(float)
    described = path.parent / "campaign.toml"
    campaign = read_toml(described) if described.is_file() else {}
    try:
        trips = _trips(time, table, height)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    wanted = _described(campaign) if campaign else {name: (name, 1.0, False) for name in sensors}
    channels = {
        sensor: Channel(time, table[column].to_numpy(float) * scale, from_rest)
        for sensor, (column, scale, from_rest) in wanted.items()
        if column in table and sensor in sensors
    }
    return Run(trips, channels, _changes(campaign, path.name), float(time[-1]))


def _table(path: Path) -> pd.DataFrame:
    try:
        table = pd.read_csv(path, skipinitialspace=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except (ValueError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not a CSV table: {' '.join(str(error).split())}") from None
    if missing := [name for name in ("time", "car_position") if name not in table]:
        raise InputError(f"{path}: no column {' and '.join(missing)}; the header has {', '.join(map(str, table.columns))}")
    numbers = table.apply(pd.to_numeric, errors="coerce")
    for name in table.columns[(numbers.isna() & table.notna()).any()]:
        row = int((numbers[name].isna() & table[name].notna()).to_numpy().argmax())
        raise InputError(f"{path}: {name} = {table[name].iloc[row]!r} in row {row + 2}: a number or an empty cell is accepted")
    return numbers


def _trips(time: Floats, table: pd.DataFrame, height: float) -> dict[str, Trip]:
    car = recover_trip(time, table["car_position"])
    if "counterweight_position" in table:
        return {"car": car, "counterweight": recover_trip(time, table["counterweight_position"])}
    return {"car": car, "counterweight": car.mirrored(height)}


def _described(campaign: dict[str, Any]) -> dict[str, tuple[str, float, bool]]:
    """Column, metres per unit, and whether it counts from rest, by sensor, as a campaign describes its channels."""
    found = {}
    for channel in campaign.get("channels", []):
        if isinstance(channel, dict) and channel.get("quantity") == "lateral_displacement" and channel.get("unit") in UNITS:
            column = str(channel.get("column"))
            found[str(channel.get("sensor"))] = column, UNITS[channel["unit"]], channel.get("reference") == "rest"
    return found


def _changes(campaign: dict[str, Any], file: str) -> dict[str, Any]:
    runs = [run for run in campaign.get("runs", []) if isinstance(run, dict) and run.get("file") == file]
    return dict(runs[0].get("set", {})) if runs else {}
