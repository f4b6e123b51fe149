"""Clearance of the rope from the shaft's wall with the new sheave: on the worst trip by the full model, parked in the sway."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from comprope.drive.parameters import Drive, Profile
from comprope.rope.effects import RopeModel

from ..simulation.trips.workflow import CarMotion, simulate
from ..tuning.task import reduced_model_of
from ..vibration.reduced_model.swing import READ_POSITIONS, SIDES
from .building_sway import BuildingSway, parked_departures


def clearances(
    model: RopeModel, profile: Profile, worst: Mapping[str, Any], sway: BuildingSway | None, wall: float
) -> list[dict[str, Any]]:
    """Least `clearance` [m] from a wall at a distance [m] in each `case`: with `side`, `height` and `car` [m] where it is.

    `worst` has the worst `trip` and, with a sway, the worst parked position `sway_car` [m].
    """
    start, end = worst["trip"]
    motion = CarMotion(start, end, profile.speed, profile.acceleration, profile.jerk, Drive())
    least = simulate(model, motion).clearance(wall).least
    found = [{"case": "worst trip", "clearance": least.clearance, "side": least.side, "height": least.height, "car": least.car}]
    if sway is None:
        return found
    reduced, car = reduced_model_of(model), float(worst["sway_car"])
    moved = parked_departures(reduced, sway, car)
    side = max(SIDES, key=lambda one: float(moved[one].max()))
    left = wall - float(moved[side].max())
    place = READ_POSITIONS[int(np.argmax(moved[side]))] * float(reduced.length(side, np.array([car]))[0]) - reduced.pit
    swayed = {
        "case": "sway, parked",
        "clearance": left,
        "side": side,
        "height": float(place),
        "car": car,
    }
    return [*found, swayed]
