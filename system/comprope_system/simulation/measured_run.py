"""A measured run for the simulation: prescribed motion of the car, and measured sensor signals.

If there is a `campaign.toml` in the folder of the run, it gives units, references and changed parameters
of that run. Without it, columns with a sensor's name are lateral displacements in metres.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.rope.model_file import read_toml

from ..measurements import Trip
from ..measurements.run_table import UNITS, read_table, read_trips

Floats = NDArray[np.float64]
LENGTHS = UNITS["lateral_displacement"]


@dataclass(frozen=True)
class Channel:
    """Lateral displacement measured at a sensor [m]; `from_rest`: relative to its mean before the trip."""

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
    """The run of a CSV file, in a shaft of this height [m]; raises `InputError` for missing columns."""
    table = read_table(path, ("time", "car_position"))
    described = path.parent / "campaign.toml"
    campaign = read_toml(described) if described.is_file() else {}
    car, counterweight = read_trips(path, table, height)
    wanted = _described(campaign) if campaign else {name: (name, 1.0, False) for name in sensors}
    time = table["time"].to_numpy(float)
    channels = {
        sensor: Channel(time, table[column].to_numpy(float) * scale, from_rest)
        for sensor, (column, scale, from_rest) in wanted.items()
        if column in table and sensor in sensors
    }
    return Run({"car": car, "counterweight": counterweight}, channels, _changes(campaign, path.name), float(time[-1]))


def _described(campaign: dict[str, Any]) -> dict[str, tuple[str, float, bool]]:
    """Column, metres per unit, and whether it is relative to rest, by sensor, from the channels of a campaign."""
    found = {}
    for channel in campaign.get("channels", []):
        if isinstance(channel, dict) and channel.get("quantity") == "lateral_displacement" and channel.get("unit") in LENGTHS:
            column = str(channel.get("column"))
            found[str(channel.get("sensor"))] = column, LENGTHS[channel["unit"]], channel.get("reference") == "rest"
    return found


def _changes(campaign: dict[str, Any], file: str) -> dict[str, Any]:
    runs = [run for run in campaign.get("runs", []) if isinstance(run, dict) and run.get("file") == file]
    return dict(runs[0].get("set", {})) if runs else {}
