"""Compact encoding of frames and traces of an animation as tables of numbers.

An array is encoded as little-endian 16-bit integers with one scale factor, in base64. The error is below 1e-4 of the largest
value, less than the width of a line.
"""

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from comprope.rope.parameters import Base

from ..rope_shapes import DEPTHS, Frame, rest_shapes

LARGEST_INTEGER, NO_VALUE = 32767, -32768


@dataclass(frozen=True)
class Trace:
    """A curve over time [s], plotted next to the animation; `sensor` is the index of its sensor, if any."""

    name: str
    unit: str
    time: ArrayLike
    value: ArrayLike
    sensor: int | None = None
    measured: tuple[ArrayLike, ArrayLike] | None = None


def animation_data(model: Base, frames: Sequence[Frame], interval: float, traces: Sequence[Trace]) -> dict[str, Any]:
    """Animation data with a frame every `interval` [s] for player.js; lengths in m, times in s."""
    return {
        "interval": interval,
        "frames": len(frames),
        "height": model.shaft.height,
        "pit": model.shaft.pit,
        "radius": model.sheave.radius,
        "sensors": [{"name": one.name, "side": one.side, "height": one.height} for one in model.sensors],
        "ends": encode_array([one.ends for one in frames]),
        "down": encode_array(DEPTHS),
        "sides": encode_array([one.sides for one in frames]),
        "rest": encode_array(rest_shapes(model, frames)),
        "arc": encode_array([one.arc for one in frames]),
        "axle": encode_array([one.axle for one in frames]),
        "angle": encode_array([one.angle for one in frames]),
        "traces": [_trace(one) for one in traces],
    }


def encode_array(values: ArrayLike) -> dict[str, Any]:
    """Encode an array of any shape as {"shape", "scale", "data"}; NaN becomes NOTHING."""
    array = np.asarray(values, float)
    finite = np.isfinite(array)
    scale = float(np.max(np.abs(array[finite]), initial=0.0)) / LARGEST_INTEGER or 1.0
    whole = np.where(finite, np.rint(np.where(finite, array, 0.0) / scale), NO_VALUE).astype("<i2")
    return {"shape": list(array.shape), "scale": scale, "data": base64.b64encode(whole.tobytes()).decode()}


def decode_array(table: dict[str, Any]) -> np.ndarray:
    """Decode the result of `encode_array`, as player.js does."""
    whole = np.frombuffer(base64.b64decode(table["data"]), "<i2").reshape(table["shape"])
    return np.where(whole == NO_VALUE, np.nan, whole * table["scale"])


def _trace(one: Trace) -> dict[str, Any]:
    table: dict[str, Any] = {"name": one.name, "unit": one.unit, "sensor": one.sensor}
    table |= {"time": encode_array(one.time), "value": encode_array(one.value)}
    if one.measured:
        table["measured"] = {"time": encode_array(one.measured[0]), "value": encode_array(one.measured[1])}
    return table
