"""The two installations of the paper, with values of the presets where the paper states none."""

from collections.abc import Mapping
from functools import cache
from typing import Any

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import SCurve, plan_s_curve
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table, load, validated, with_changes
from comprope.rope.parameters import Base

from . import model_path

TOWER, BUILDING = "tower50", "building200"
START = 0.5  # s at rest before a trip
LIMITS = {  # speed [m/s], acceleration [m/s2] of Tables 2 and 3; jerk [m/s3]: customary, and from the 10.2 s of Fig. 7
    TOWER: (2.5, 0.8, 0.8),
    BUILDING: (9.0, 1.1, 0.93),
}


@cache
def _loaded(name: str) -> RopeModel:
    return load(model_path(name))


def installation(name: str, changes: Mapping[str, Any] | None = None) -> RopeModel:
    """A preset or model file with some values changed."""
    return with_changes(_loaded(name), changes or {})


def sheave_changes(model: Base | str, mass: float) -> dict[str, float]:
    """Changes that give a building a sheave of another mass [kg], with inertia in proportion."""
    sheave = (_loaded(model) if isinstance(model, str) else model).sheave
    return {"sheave.mass": mass, "sheave.inertia": sheave.inertia * mass / sheave.mass}


def limits(name: str, distance: float) -> dict[str, float]:
    """A trip up from the bottom landing over a distance [m] as a case has it; a model file runs as the 200 m building does."""
    speed, acceleration, jerk = LIMITS.get(name, LIMITS[BUILDING])
    return {"distance": distance, "speed": speed, "acceleration": acceleration, "jerk": jerk}


def jerk_limited_trip(distance: float, speed: float, acceleration: float, jerk: float, origin: float = 0.0) -> SCurve:
    """The trip up over `distance` [m] within the limits of speed [m/s], acceleration [m/s2] and jerk [m/s3]."""
    limits = Profile(speed=speed, acceleration=acceleration, jerk=jerk)
    return plan_s_curve(limits, origin, origin + distance, START)


def trip_up(name: str, distance: float) -> SCurve:
    """The trip of a case."""
    return jerk_limited_trip(**limits(name, distance))


def table(name: str, changes: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """A building as part of a case: the complete model, so that workers need no file and a changed file is a different case."""
    return as_table(installation(name, changes))


def model_of_case(case: Mapping[str, Any], changes: Mapping[str, Any] | None = None) -> RopeModel:
    """The model of a case, with some values changed."""
    return with_changes(validated(case["model"], "case"), changes or {})
