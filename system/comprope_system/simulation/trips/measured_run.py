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

from comprope.errors import InputError

from ...measurements import Trip
from ...measurements.campaign_file import CampaignFile, RunSpec, read_campaign_file
from ...measurements.campaign_file import Channel as MeasuredChannel
from ...measurements.motion.anchoring import Landings
from ...measurements.motion.recover import Motion
from ...measurements.runs.end_motions import EndSignals, recover_ends
from ...measurements.runs.run_table import present_channels, read_run_table
from ...measurements.units import UNITS
from ..cosim.master import Coupling
from .timing import Timing

Floats = NDArray[np.float64]
QUANTITIES = tuple(UNITS)  # of channels; a result has a column of the same name for each that is not of a sensor


@dataclass(frozen=True)
class Channel:
    """Measured values of a column of the result [SI]; `from_rest`: relative to their mean before the trip."""

    time: Floats
    value: Floats
    from_rest: bool


@dataclass(frozen=True)
class Run:
    """A measured run.

    Trips of "car" and "counterweight", outward displacements [m] of the rope's ends by the same names where measured, channels by
    column of the result, changes of the model, first and last time [s], and remarks about the file and the recovered motion.
    """

    trips: dict[str, Trip]
    lateral: dict[str, Trip]
    channels: dict[str, Channel]
    changes: dict[str, Any]
    begin: float
    end: float
    remarks: tuple[str, ...] = ()

    @property
    def simulation_start(self) -> float:
        """The time [s] from which on the rope is simulated: that of a run-up, where the record begins under way."""
        return min(self.begin, *(trip.rest_before for trip in self.trips.values()))


@dataclass(frozen=True)
class MotionWishes:
    """How the motion is recovered, and heights of the car [m] at the start and end of the record; None as in the campaign."""

    motion: Motion | None = None
    start: float | None = None
    end: float | None = None


def read_run(path: Path, height: float, sensors: Sequence[str], wishes: MotionWishes | None = None) -> Run:
    """The run of a file, in a shaft of this height [m]; raises `InputError` for a file without the car's motion."""
    described = path.parent / "campaign.toml"
    campaign = read_campaign_file(described) if described.is_file() else _undescribed(path.name, sensors)
    spec = next((one for one in campaign.runs if one.file == path.name), RunSpec(file=path.name))
    wishes = wishes or MotionWishes()
    asked = {"motion": wishes.motion, "car_start": wishes.start, "car_end": wishes.end}
    spec = spec.model_copy(update={key: value for key, value in asked.items() if value is not None})
    wanted = [one for one in campaign.channels if (one.sensor or one.quantity) in (*sensors, *QUANTITIES)]
    campaign = campaign.model_copy(update={"channels": present_channels(path.parent, spec, campaign.file, wanted)})
    within = path.parent if spec.files else None  # the file itself was named by the user, others by its campaign
    table = read_run_table(path.parent, spec, campaign, height, within)
    signals = EndSignals(table.car, table.counterweight, table.lateral)
    ends = recover_ends(signals, height, spec.motion or campaign.motion, Landings(spec.car_start, spec.car_end), str(path))
    channels = {
        one.sensor or one.quantity: Channel(table.time, table.values[one.column], one.reference == "rest")
        for one in campaign.channels
    }
    trips, begin, end = {"car": ends.car, "counterweight": ends.counterweight}, float(table.time[0]), float(table.time[-1])
    return Run(trips, ends.lateral, channels, dict(spec.set), begin, end, (*table.remarks, *ends.remarks))


def measured_timing(run: Run, duration: float | None, step: float, coupling: Coupling) -> Timing:
    """Simulated time of a run, by default all of it; raises `InputError` for more than a record that ends under way."""
    recorded = run.end - run.begin
    if duration is not None and duration > recorded and any(np.isinf(trip.rest_after) for trip in run.trips.values()):
        raise InputError(f"duration = {duration:g} s: the record ends under way after {recorded:g} s, which is the most accepted")
    return Timing(recorded if duration is None else duration, step, coupling, run.begin, run.begin - run.simulation_start)


def _undescribed(file: str, sensors: Sequence[str]) -> CampaignFile:
    """What a run without campaign.toml is taken for: columns with the names of sensors are lateral displacements in metres."""
    channels = tuple(MeasuredChannel(column=name, sensor=name, quantity="lateral_displacement", unit="m") for name in sensors)
    return CampaignFile(name=file, model="", channels=channels, runs=(RunSpec(file=file),))
