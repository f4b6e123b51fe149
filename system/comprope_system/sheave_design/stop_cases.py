"""Stops of the car on its way down from the top landing: what the sheave and the rope take in each, by the full model."""

from collections.abc import Mapping
from typing import Any

from scipy.optimize import brentq

from comprope.drive.parameters import Drive, Profile
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table, validated

from ..simulation.trips.stop import Stop
from ..simulation.trips.workflow import CarMotion, simulate
from .trip_envelopes import floor_heights

STOPS = {"drive": Stop(), "1 g": Stop(deceleration=9.81), "safety gear": Stop(safety_gear=True)}
AFTER = 5.0  # s simulated after a stop begins: the counterweight has landed, and the sheave bounces
START = 1.0  # s at rest before the trip
COLUMNS = ("stop", "height", "speed", "rise", "sheave_force", "peak_tension", "slack_duration")


def stop_cases(model: RopeModel, profile: Profile, floors: int, wall: float | None = None) -> list[dict[str, Any]]:
    """One case for each kind of stop and each floor between the terminal landings, in what JSON can hold; `wall` [m]."""
    table, limits = as_table(model), profile.model_dump()
    heights = floor_heights(model.shaft.height, floors)[1:-1].tolist()
    same = {"model": table, "profile": limits, "wall": wall}
    return [same | {"stop": name, "height": height} for name in STOPS for height in heights]


def stop_case(case: Mapping[str, Any]) -> dict[str, Any]:
    """A stop as the car passes a height: see COLUMNS for what it gives, in m, m/s, N and s; with a wall the `clearance` [m]."""
    model, profile = validated(case["model"], "case"), Profile.model_validate(case["profile"])
    top, stop = model.shaft.height, STOPS[case["stop"]]
    trip = plan_s_curve(profile, top, 0.0, START)
    time = float(brentq(lambda at: trip.at(at).position - case["height"], START, trip.end_time))
    motion = CarMotion(
        top, 0.0, profile.speed, profile.acceleration, profile.jerk, Drive(),
        stop=Stop(time, stop.deceleration, stop.safety_gear),
    )  # fmt: skip
    result = simulate(model, motion, duration=time + AFTER)
    table = result.table
    rise = table["sheave_displacement"].max() - table["sheave_displacement"].iloc[0]
    values = (
        case["stop"], case["height"], -trip.at(time).velocity, float(rise), float(table["sheave_force"].max()),
        float(table["peak_element_tension"].iloc[-1]), float(table["slack_duration"].iloc[-1]),
    )  # fmt: skip
    beside = {} if case["wall"] is None else {"clearance": result.clearance(case["wall"]).least.clearance}
    return dict(zip(COLUMNS, values, strict=True)) | beside
