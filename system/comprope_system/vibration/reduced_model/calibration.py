"""Calibration of the rope's offset at the sheave by a short trip of the full model: static, and with speed and acceleration."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table, validated
from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.side_shape import side_shape

from ..prescribed_trip import record_trip
from .string_dynamics import FRICTION_TRANSITION_SPEED, StringParameters, rest_shape, string_parameters

Floats = NDArray[np.float64]

LIMITS = Profile(speed=5.0, acceleration=0.6, jerk=0.8)
NEAR, FAR, READ_COUNT = 5.0, 9.0, 5  # where the offset is read: so many bending lengths above the axle
MIN_HEIGHT = 70.0  # m, of the low shaft
OTHER_EXCITATION = ("building_sway", "attachment_offset", "sheave_eccentricity")  # effects that swing the rope by themselves


@lru_cache(maxsize=16)
def calibrated_string(model: RopeModel) -> StringParameters:
    """A side of the rope with `offset_coefficients` calibrated by the full model in a low shaft; takes one or two seconds.

    Raises `InputError` where the rope does not wrap the sheave.
    """
    rope = string_parameters(model)
    bending = rope.bending_length
    heights = np.linspace(NEAR, FAR, READ_COUNT) * bending - model.shaft.pit
    low = _low_shaft(model, MIN_HEIGHT + 2.0 * FAR * bending)
    trip = plan_s_curve(LIMITS, 0.1 * low.shaft.height, 0.9 * low.shaft.height, 0.5)

    def evaluate(full: CompensationRope) -> Floats:
        return np.array([side_shape(full, side, heights) for side in ("car", "counterweight")])

    times, samples = record_trip(low, trip, trip.end_time + 1.0, evaluate)
    motions = [trip.at(time) for time in times]
    car = np.array([one.position for one in motions])
    speed, pull = np.array([one.velocity for one in motions]), np.array([one.acceleration for one in motions])
    rows, values = [], []
    for k, sign in enumerate((1.0, -1.0)):
        length = low.shaft.pit + (car if sign > 0.0 else low.shaft.height - car)
        shape = np.array([rest_shape(rope, one, (heights + low.shaft.pit) / one)[0] for one in length[:, None]]) / rope.offset
        own = rope.bending_stiffness / (2.0 * rope.radius * (rope.weight + sign * rope.rotating_mass * pull))
        values.append((samples[:, k] / shape).mean(axis=1) / own)
        rows.append(np.array([np.ones_like(speed), sign * speed, speed**2, np.tanh(sign * speed / FRICTION_TRANSITION_SPEED)]).T)
    offset_coefficients, *_ = np.linalg.lstsq(np.concatenate(rows), np.concatenate(values), rcond=None)
    g0, g1, g2, g3 = (float(one) for one in offset_coefficients)
    return replace(rope, offset_coefficients=(g0, g1, g2, g3))


def _low_shaft(model: RopeModel, height: float) -> RopeModel:
    """The same rope and sheave in a shaft of `height` [m], without other excitation and without sensors."""
    table = as_table(model)
    table["shaft"] = {**table["shaft"], "height": float(height)}
    table["effects"] = {name: part for name, part in table.get("effects", {}).items() if name not in OTHER_EXCITATION}
    table["sensors"] = []
    return validated(table, "calibration")
