"""Measured runs in SI units."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...measurements import Trip
from ...measurements.campaign_file import Channel
from ..settings import TRIP_PHASES

__all__ = ["Channel", "Run"]

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Run:
    """Measured run in SI units: `values[column]` (n,) at `time` (n,) [s], NaN where a sample is missing.

    `changes` are the parameters that differ from the model file; `trip` and `counterweight` are smooth trajectories fitted to
    the measured positions; `notes` are messages about the data. `sampled[column]` (n,) are the times at which a channel with a
    clock of its own has a sample; `lateral` are outward displacements [m] of the rope ends "car" and "counterweight".
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
    sampled: dict[str, NDArray[np.bool_]] = field(default_factory=dict)
    lateral: dict[str, Trip] = field(default_factory=dict)
    started: float | None = None

    @property
    def rest(self) -> NDArray[np.bool_]:
        """Samples (n,) before the trip."""
        return np.asarray(self.time <= max(self.trip.rest_before, self.time[0] + TRIP_PHASES.rest_duration))

    @property
    def moving(self) -> NDArray[np.bool_]:
        """Samples (n,) during the trip."""
        return np.asarray((self.time > self.trip.rest_before) & (self.time < self.trip.rest_after) & (self.trip.kind != "rest"))

    def samples_of(self, column: str) -> NDArray[np.bool_]:
        """Times (n,) at which a channel has a sample: all, unless it has a clock of its own."""
        return self.sampled.get(column, np.ones(len(self.time), bool))
