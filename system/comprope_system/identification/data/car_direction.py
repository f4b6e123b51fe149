"""Whether the position of the car counts upward: seen from where sensors see the rope, which hangs only below its ends."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel

from ...measurements import Trip
from ...measurements.campaign_file import Channel
from ..settings import PLAUSIBILITY

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Agreement:
    """Share of samples that exist just where the rope is in view: as described, with the car mirrored, and by other sensors."""

    described: float
    mirrored: float
    others: Mapping[str, float]


def agreement(
    model: RopeModel, channel: Channel, value: Floats, trips: tuple[Trip, Trip], time: Floats
) -> Agreement | None:
    """How the gaps of a lateral channel (n,) agree with the trips of car and counterweight at `time` (n,) [s].

    None for a channel without gaps that could tell, or of a sensor that the model does not have.
    """
    finite = np.isfinite(value)
    sensor = next((one for one in model.sensors if one.name == channel.sensor), None)
    if sensor is None or not PLAUSIBILITY.min_gaps < float(np.mean(~finite)) < 1.0 - PLAUSIBILITY.min_gaps:
        return None
    car, counterweight = (trip.position(time) for trip in trips)
    ends = {"car": car, "counterweight": counterweight}

    def share(end: Floats, height: float) -> float:
        return float(np.mean(finite == (end > height)))

    other_side = "car" if sensor.side == "counterweight" else "counterweight"
    others = {one.name: share(ends[one.side], one.height) for one in model.sensors if one.name != sensor.name}
    others[f"on the {other_side}'s side at the same height"] = share(ends[other_side], sensor.height)
    own = ends[sensor.side]
    return Agreement(share(own, sensor.height), share(model.shaft.height - own, sensor.height), others)


def mirrored_car(
    model: RopeModel, channels: Sequence[Channel], values: Mapping[str, Floats], trips: tuple[Trip, Trip], time: Floats
) -> str | None:
    """A sentence if the sensors see the rope just where they would if the car's position counted downward; otherwise None."""
    lateral = [one for one in channels if one.quantity == "lateral_displacement" and one.column in values]
    found = [one for channel in lateral if (one := agreement(model, channel, values[channel.column], trips, time))]
    turning = [one.column for one in channels if one.quantity == "sheave_angular_velocity" and one.column in values]
    speed = trips[0].velocity(time) / model.sheave.radius
    forward = any(regression(values[column], speed)[1] > PLAUSIBILITY.min_correlation for column in turning)
    if not found or forward or not all(is_other(one.described, one.mirrored) for one in found):
        return None
    return (
        "the lasers see the rope where they would with the car at the other end of the shaft: car_position counts downward? "
        f"Write sign = -1 and zero = {model.shaft.height:g} (its reading at the bottom landing; a thousand times that "
        "if it is in mm) under [car]"
    )


def is_other(described: float, other: float) -> bool:
    """Whether samples agree well with another arrangement and poorly with the one described."""
    return described < PLAUSIBILITY.poor_view and other > PLAUSIBILITY.good_view


def regression(value: Floats, rolling: Floats) -> tuple[float, float]:
    """Ratio of a channel (n,) to the rolling speed (n,) [rad/s], and their correlation; NaN where the car hardly moves."""
    known = np.isfinite(value)
    x, y = rolling[known], value[known]
    xx, yy, xy = float(x @ x), float(y @ y), float(x @ y)
    if xx == 0.0 or yy == 0.0 or np.max(np.abs(x)) < PLAUSIBILITY.min_rolling:
        return float("nan"), 0.0
    return xy / xx, xy / (xx * yy) ** 0.5
