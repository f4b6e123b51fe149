"""Causes in the instrument: what a channel makes of what is there."""

from collections.abc import Callable, Mapping

import numpy as np

from .tower import Floats

Fault = Callable[[Floats, Floats, Mapping[str, float]], Floats]


def sensor_gain(time: Floats, values: Floats, by: Mapping[str, float]) -> Floats:
    """The channel reads too much."""
    return (1.0 + by["excess"]) * values


def sensor_offset(time: Floats, values: Floats, by: Mapping[str, float]) -> Floats:
    """The channel reads something at nothing."""
    return values + by["offset"]


def sensor_delay(time: Floats, values: Floats, by: Mapping[str, float]) -> Floats:
    """The channel reads what was a while ago."""
    return np.interp(time - by["delay"], time, values)


def sensor_drift(time: Floats, values: Floats, by: Mapping[str, float]) -> Floats:
    """The channel's zero wanders, steadily in time."""
    return values + by["per_minute"] * time / 60.0


def wrong_sign(time: Floats, values: Floats, by: Mapping[str, float]) -> Floats:
    """The channel was connected the wrong way round."""
    return -values


def wrong_unit(time: Floats, values: Floats, by: Mapping[str, float]) -> Floats:
    """The channel was written in a larger unit than stated: centimetres for millimetres."""
    return values * by["factor"]
