"""Swing of the rope while the car travels through the whole shaft of a building that sways, by the full model.

The building sways harmonically by the effect `building_sway` from the start of the trip, when the rope is at rest for it.
"""

import numpy as np

from comprope.drive.parameters import Drive, Profile
from comprope.drive.trajectory.reference_trajectory import reference_trajectory
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import with_changes

from ..reduced_model.string_dynamics import string_parameters
from ..reduced_model.swing import READ_POSITIONS, SIDES, ReducedModel, full_model_swing, side_swing
from .parked_response import Floats, Sway


def travelling_swing(model: RopeModel, sway: Sway, period: float, speed: float) -> Floats:
    """Largest displacement of either side relative to the building [m], on the way up and down (2,) at a speed [m/s]."""
    values = {"amplitude": sway.amplitude, "frequency": 1.0 / period, "phase": 0.5 * np.pi}
    swayed = with_changes(model, {f"effects.building_sway.{name}": one for name, one in values.items()})
    return np.array([_trip(swayed, sway, period, speed, up) for up in (True, False)])


def _trip(model: RopeModel, sway: Sway, period: float, speed: float, up: bool) -> float:
    """The same of one trip between the terminal landings."""
    height, pit = model.shaft.height, model.shaft.pit
    profile, ends = Profile(speed=speed), (0.0, height) if up else (height, 0.0)
    trip = reference_trajectory(Drive(profile=profile), plan_s_curve(profile, *ends, 0.0))
    reduced = ReducedModel(string_parameters(model), height, pit)
    _, traces = full_model_swing(model, reduced, trip, 0.0)
    time = traces["time"]
    car = np.array([trip.at(float(one)).position for one in time])
    top = sway.amplitude * np.cos(2.0 * np.pi * time / period)
    largest = 0.0
    for side in SIDES:
        length = reduced.length(side, car)
        building = (length / (height + pit) * top)[:, None] * READ_POSITIONS
        outward = -building if side == "car" else building
        largest = max(largest, side_swing(reduced, time, np.inf, length, traces[side] - outward).during)
    return largest
