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

from .frames import DOWN, Frame, at_rest

LARGEST, NOTHING = 32767, -32768


@dataclass(frozen=True)
class Trace:
    """A curve over time [s], plotted next to the animation; `sensor` is the index of its sensor, if any."""

    name: str
    unit: str
    time: ArrayLike
    value: ArrayLike
    sensor: int | None = None
    measured: tuple[ArrayLike, ArrayLike] | None = None


def film(model: Base, frames: Sequence[Frame], interval: float, traces: Sequence[Trace]) -> dict[str, Any]:
    """Animation data with a frame every `interval` [s] for player.js; lengths in m, times in s."""
    return {
        "interval": interval,
        "frames": len(frames),
        "height": model.shaft.height,
        "pit": model.shaft.pit,
        "radius": model.sheave.radius,
        "sensors": [{"name": one.name, "side": one.side, "height": one.height} for one in model.sensors],
        "ends": packed([one.ends for one in frames]),
        "down": packed(DOWN),
        "sides": packed([one.sides for one in frames]),
        "rest": packed(at_rest(model, frames)),
        "arc": packed([one.arc for one in frames]),
        "axle": packed([one.axle for one in frames]),
        "angle": packed([one.angle for one in frames]),
        "traces": [_trace(one) for one in traces],
    }


def packed(values: ArrayLike) -> dict[str, Any]:
    """Encode an array of any shape as {"shape", "scale", "data"}; NaN becomes NOTHING."""
    array = np.asarray(values, float)
    finite = np.isfinite(array)
    scale = float(np.max(np.abs(array[finite]), initial=0.0)) / LARGEST or 1.0
    whole = np.where(finite, np.rint(np.where(finite, array, 0.0) / scale), NOTHING).astype("<i2")
    return {"shape": list(array.shape), "scale": scale, "data": base64.b64encode(whole.tobytes()).decode()}


def unpacked(table: dict[str, Any]) -> np.ndarray:
    """Decode the result of `packed`, as player.js does."""
    whole = np.frombuffer(base64.b64decode(table["data"]), "<i2").reshape(table["shape"])
    return np.where(whole == NOTHING, np.nan, whole * table["scale"])


def _trace(one: Trace) -> dict[str, Any]:
    table: dict[str, Any] = {"name": one.name, "unit": one.unit, "sensor": one.sensor}
    table |= {"time": packed(one.time), "value": packed(one.value)}
    if one.measured:
        table["measured"] = {"time": packed(one.measured[0]), "value": packed(one.measured[1])}
    return table
