"""Swing of the rope on a trip up from the bottom, by all measures that a figure of the paper may show."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.side_shape import side_shape

from ...parallel.sweep import Case
from ...presets.paper_installations import jerk_limited_trip, limits, model_of_case, table
from ...vibration.modal.hanging_string import side_string
from ...vibration.prescribed_trip import Floats, record_trip

AFTER = 20.0  # s watched after the trip: the rope's slowest period and more
FRACTIONS = np.linspace(0.02, 0.98, 25)  # of the free length, from the axle to the end
MIDDLE = len(FRACTIONS) // 2

# Measures, each one number [m] for one trip, in words.
MEASURES = {
    "middle_after": "middle of the rope, half its swing after the trip",
    "mode_after": "slowest swing of the side alone, half of it after the trip",
    "middle_rest": "middle of the rope, farthest from rest, trip included",
    "whole_after": "anywhere on the side, half the swing after the trip",
    "whole_rest": "anywhere on the side, farthest from rest, trip included",
    "outward": "anywhere on the side, farthest outward, static offset included",
    "low_rest": "sensor 2 m above the axle, farthest from rest",
    "half_shaft_after": "sensor at half the shaft's height, half the swing after the trip",
    "half_shaft_rest": "sensor at half the shaft's height, farthest from rest",
    "car_after": "middle of the car's side, half the swing after the trip",
}


def swing_case(name: str, distance: float, changes: Mapping[str, Any] | None = None) -> Case:
    """A case for `swing`."""
    return {"model": table(name, changes), "trip": limits(name, distance)}


def swing(case: Case) -> dict[str, Any]:
    """Run a trip; its duration [s], every one of MEASURES [m], and half the swing after it by height [m]."""
    model, trip = model_of_case(case), jerk_limited_trip(**case["trip"])
    low = 2.0 - model.shaft.pit
    heights = np.concatenate([[low, 0.5 * model.shaft.height], np.linspace(0.0, model.shaft.height, 41)])

    def evaluate(rope: CompensationRope) -> Floats:
        return np.concatenate([_along(rope, "counterweight"), side_shape(rope, "counterweight", heights), _along(rope, "car")])

    time, samples = record_trip(model, trip, trip.end_time + AFTER, evaluate)
    own, fixed, car = np.split(samples, [len(FRACTIONS), len(FRACTIONS) + len(heights)], axis=1)
    after = time > trip.end_time
    by_height = half_swing(fixed[after][:, 2:])
    return {
        "duration": trip.duration,
        "heights": heights[2:].tolist(),
        "by_height": np.where(np.isfinite(by_height), by_height, -1.0).tolist(),
        "mode_after": float(half_swing((own[after] @ _slowest(model, trip.destination))[:, None])[0]),
        **_measures(own, fixed, car, after),
    }


def _slowest(model: Base, car: float) -> Floats:
    """Weights of displacements at FRACTIONS that give the size of the slowest swing: sin(pi t) over travel time t from 0 to 1."""
    string = side_string(model, car)
    share = string.share_at(FRACTIONS * string.length)
    weights = np.sin(np.pi * share) * np.gradient(share)
    return np.asarray(weights / (weights @ np.sin(np.pi * share)))


def _along(rope: CompensationRope, side: str) -> Floats:
    """Outward displacement [m] at FRACTIONS of a side's free length."""
    q, n = rope.state.q, rope.n
    axle, end = -q[n], -q[n - 1 if side == "counterweight" else 0]
    return side_shape(rope, side, axle + FRACTIONS * (end - axle))


def _measures(own: Floats, fixed: Floats, car: Floats, after: NDArray[np.bool_]) -> dict[str, float]:
    """MEASURES from displacements over time (times, places) along the side, at fixed heights and along the car's side."""
    return {
        "middle_after": float(half_swing(own[after])[MIDDLE]),
        "middle_rest": float(from_rest(own)[MIDDLE]),
        "whole_after": float(half_swing(own[after]).max()),
        "whole_rest": float(np.nanmax(from_rest(fixed))),
        "outward": float(own.max()),
        "low_rest": float(from_rest(fixed)[0]),
        "half_shaft_after": float(half_swing(fixed[after])[1]),
        "half_shaft_rest": float(from_rest(fixed)[1]),
        "car_after": float(half_swing(car[after])[MIDDLE]),
    }


def half_swing(values: Floats) -> Floats:
    """Half the peak-to-peak value over time, for each place (times, places); NaN where the rope was not always in view."""
    return 0.5 * (values.max(axis=0) - values.min(axis=0))


def from_rest(values: Floats) -> Floats:
    """Largest deviation from the first value over time, for each place, while the rope is in view."""
    away = np.abs(values - values[0])
    return np.where(np.isfinite(away), away, 0.0).max(axis=0)
