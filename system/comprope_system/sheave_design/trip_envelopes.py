"""Swing of all trips between floors for one sheave mass with the reduced model, and of the worst one with the full model."""

from collections.abc import Mapping
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import validated, with_changes

from ..presets.paper_installations import sheave_changes
from ..tuning.search.profile_families import REST_BEFORE
from ..tuning.task import reduced_model_of
from ..vibration.reduced_model.sampled_motion import sample_motion
from ..vibration.reduced_model.swing import (
    READ_POSITIONS,
    SEARCH_STEP,
    ReducedModel,
    departures_from_rest,
    full_model_swing,
    observation_time,
    reduced_swing,
)
from .building_sway import BuildingSway, worst_parked

Floats = NDArray[np.float64]


def floor_heights(height: float, count: int) -> Floats:
    """Heights of `count` floors [m], evenly from the bottom to the top landing."""
    return np.linspace(0.0, height, count)


def trips_between(heights: Floats) -> list[tuple[float, float]]:
    """All trips between floors [m] except mirror images, which give the same swing on the other side."""
    top = heights[-1]
    found = set()
    for start, end in permutations(heights.tolist(), 2):
        if (round(top - start, 6), round(top - end, 6)) not in found:
            found.add((round(start, 6), round(end, 6)))
    return sorted(found)


def s_curve_trajectory(profile: Profile, trip: tuple[float, float]) -> ReferenceTrajectory:
    """Jerk-limited reference trajectory of a trip."""
    return ReferenceTrajectory(plan_s_curve(profile, *trip, REST_BEFORE))


def model_with_sheave(model: RopeModel, mass: float) -> RopeModel:
    """The model with another sheave mass [kg], inertia in proportion."""
    return with_changes(model, sheave_changes(model, mass))


def mass_case(case: Mapping[str, Any]) -> dict[str, Any]:
    """The worst trip and the worst parked floor of a sheave's mass: a case of a sweep; swings in m, heights in m."""
    model = model_with_sheave(validated(case["model"], "case"), case["mass"])
    reduced, profile = reduced_model_of(model), Profile.model_validate(case["profile"])
    heights = floor_heights(model.shaft.height, case["floors"])
    tails = {float(height): observation_time(model, float(height)) for height in heights}
    swings = []
    for trip in trips_between(heights):
        swing = reduced_swing(reduced, s_curve_trajectory(profile, trip), tails[min(tails, key=lambda one: abs(one - trip[1]))])
        swings.append((max(swing.during, swing.after), swing.after, *trip))
    largest = max(swings)
    sway = BuildingSway(**case["sway"]) if case["sway"] else None
    swayed = worst_parked(reduced, sway, heights) if sway else (0.0, 0.0)
    return {
        "mass": case["mass"], "trip": [largest[2], largest[3]], "swing": largest[0], "after": max(one[1] for one in swings),
        "sway": swayed[0], "sway_car": swayed[1], "offset": reduced.rope.offset,
    }  # fmt: skip


def full_model_case(case: Mapping[str, Any]) -> float:
    """The swing [m] of one trip on the full model with a sheave of some mass: a case of a sweep."""
    model = model_with_sheave(validated(case["model"], "case"), case["mass"])
    trip = (case["trip"][0], case["trip"][1])
    swing, _ = full_model_swing(
        model,
        reduced_model_of(model),
        s_curve_trajectory(Profile.model_validate(case["profile"]), trip),
        observation_time(model, trip[1]),
    )
    return max(swing.during, swing.after)


def envelopes(
    reduced: ReducedModel, profile: Profile, trip: tuple[float, float], observation: float, heights: Floats
) -> list[dict[str, Floats]]:
    """Largest displacements [m] during and after a trip, at `heights` [m], by side; 0 where there is no rope."""
    trajectory = s_curve_trajectory(profile, trip)
    motion = sample_motion(trajectory, trajectory.end_time + observation, SEARCH_STEP)
    whole, after = dict[str, Floats](), dict[str, Floats]()
    for side, (length, departure) in departures_from_rest(reduced, motion).items():
        envelope = np.abs(_at_heights(departure, length, heights + reduced.pit))
        whole[side], after[side] = envelope.max(axis=0), envelope[motion.time > trajectory.end_time].max(axis=0)
    return [whole, after]


def _at_heights(departure: Floats, length: Floats, above: Floats) -> Floats:
    """Displacements (n, heights) at heights `above` the axle [m], interpolated from READ_POSITIONS; 0 beyond these."""
    place = (above / length[:, None] - READ_POSITIONS[0]) / (READ_POSITIONS[1] - READ_POSITIONS[0])
    k = np.clip(place.astype(int), 0, len(READ_POSITIONS) - 2)
    rows = np.arange(len(length))[:, None]
    between = (1.0 - place + k) * departure[rows, k] + (place - k) * departure[rows, k + 1]
    return np.where((place >= 0.0) & (place <= len(READ_POSITIONS) - 1), between, 0.0)
