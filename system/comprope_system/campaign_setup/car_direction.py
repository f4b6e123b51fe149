"""Whether the positions of the car count downward, and what that makes of the sign of the sheave."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from comprope.rope.effects import RopeModel

from ..identification.data.car_direction import Agreement, agreement, is_other
from ..measurements.campaign_file import Channel
from .column_matching import own_name
from .column_roles import Role
from .survey.surveyed_runs import SurveyedRun


def counts_downward(runs: Sequence[SurveyedRun], found: Mapping[str, Role], model: RopeModel) -> bool:
    """Whether all lasers see the rope where they would if positions counted down from the top landing, and the sheave agrees."""
    turning = [role for role in found.values() if role.quantity == "sheave_angular_velocity"]
    if any(run.car.quantity != "position" or run.trip is None for run in runs) or any(role.sign > 0 for role in turning):
        return False
    if len({run.car.unit for run in runs}) > 1:  # one reading at the bottom landing is stated for all runs
        return False
    seen = [one for run in runs for one in _agreements(run, found, model)]
    return bool(seen) and all(is_other(one.described, one.mirrored) for one in seen)


def _agreements(run: SurveyedRun, found: Mapping[str, Role], model: RopeModel) -> list[Agreement]:
    agreements = []
    for name, role in found.items():
        own = own_name(run, name)
        if role.quantity != "lateral_displacement" or own is None or run.trip is None:
            continue
        channel = Channel(column=name, quantity="lateral_displacement", sensor=role.sensor, unit=role.unit)
        samples, trips = run.columns[own].samples, (run.trip, run.trip.mirrored(model.shaft.height))
        if seen := agreement(model, channel, samples.values, trips, samples.time):
            agreements.append(seen)
    return agreements


def with_sheave_turned(found: Mapping[str, Role]) -> dict[str, Role]:
    """The roles with a sheave that turns as the car moves, once that is read with the other sign."""
    turned = "sheave_angular_velocity"
    return {name: replace(role, sign=-role.sign) if role.quantity == turned else role for name, role in found.items()}
