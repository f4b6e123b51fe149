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

from ..measurements import Trip
from ..measurements.campaign_file import CampaignFile, RunSpec, read_campaign_file
from ..measurements.campaign_file import Channel as MeasuredChannel
from ..measurements.run_table import present_channels, read_run_table, read_trips

Floats = NDArray[np.float64]


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
    """The run of a file, in a shaft of this height [m]; raises `InputError` for a file without the car's motion."""
    described = path.parent / "campaign.toml"
    campaign = read_campaign_file(described) if described.is_file() else _undescribed(path.name, sensors)
    spec = next((one for one in campaign.runs if one.file == path.name), RunSpec(file=path.name))
    wanted = [one for one in campaign.channels if one.quantity == "lateral_displacement" and one.sensor in sensors]
    campaign = campaign.model_copy(update={"channels": present_channels(path.parent, spec, campaign.file, wanted)})
    table = read_run_table(path.parent, spec, campaign, height, None)
    car, counterweight = read_trips(table.car, table.counterweight, height, str(path))
    channels = {
        str(one.sensor): Channel(table.time, table.values[one.column], one.reference == "rest") for one in campaign.channels
    }
    return Run({"car": car, "counterweight": counterweight}, channels, dict(spec.set), float(table.time[-1]))


def _undescribed(file: str, sensors: Sequence[str]) -> CampaignFile:
    """What a run without campaign.toml is taken for: columns with the names of sensors are lateral displacements in metres."""
    channels = tuple(MeasuredChannel(column=name, sensor=name, quantity="lateral_displacement", unit="m") for name in sensors)
    return CampaignFile(name=file, model="", channels=channels, runs=(RunSpec(file=file),))
