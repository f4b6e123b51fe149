"""Phases of a trip: rest, acceleration, cruise, deceleration, and after the stop."""

import numpy as np
from numpy.typing import NDArray

from ...measurements import Trip
from ..settings import TRIP_PHASES

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
PHASES = ("rest", "acceleration", "cruise", "deceleration", "after_stop")


def phases(trip: Trip, time: Floats) -> dict[str, Mask]:
    """Samples (n,) of each phase at `time` (n,) [s]; each sample lies in exactly one phase.

    The limits of the cruise are found from the speed, which a recovered trip has more accurately than the acceleration.
    """
    speed = np.abs(trip.velocity(time))
    fast = np.flatnonzero(speed >= TRIP_PHASES.cruise_speed * speed.max()) if speed.any() else np.array([len(time), -1])
    before, index = time <= trip.rest_before, np.arange(len(time))
    if not speed.any():
        before = np.ones(len(time), bool)
    after = (time >= trip.rest_after) & ~before
    moving = ~before & ~after
    masks = (
        before,
        moving & (index < fast[0]),
        moving & (index >= fast[0]) & (index <= fast[-1]),
        moving & (index > fast[-1]),
        after,
    )
    return dict(zip(PHASES, masks, strict=True))
