"""Sensitivities along a run, against central differences of whole runs."""

from dataclasses import replace
from functools import cache
from math import pi

import numpy as np
import pytest
from comprope.errors import InputError
from comprope.rope.model import CompensationRope, values_of
from comprope.rope.modelfile import with_changes
from comprope.rope.sensitivity import SensitiveRope
from comprope.rope.slots import DECLARED
from comprope_system.identify.campaign import Channel, Run
from comprope_system.identify.replay import replay
from comprope_system.identify.sensitivities import replay_with_sensitivities
from comprope_system.trips import Trip
from comprope_system.trips.profile import jerk_limited

from .virtual_lift import LASER
from .virtual_lift import MODEL as COARSE

MODEL = with_changes(COARSE, {"rope.element_length": 0.05})

LASERS = {name: Channel(column=name, sensor=name, **LASER) for name in ("cw_low", "car_low")}
CHANNELS = LASERS | {
    "axle": Channel(column="axle", quantity="sheave_displacement", unit="mm"),
    "turning": Channel(column="turning", quantity="sheave_angular_velocity", unit="rad/s"),
    "weight": Channel(column="weight", quantity="sheave_force", unit="N"),
    "pull": Channel(column="pull", quantity="car_end_tension", unit="N"),
}
DIRECTIONS = {
    "bending": {"rope.bending_stiffness": 1.0},
    "damping": {"rope.bending_damping": 1.0},
    "rope mass": {"rope.mass_per_length": 1.0},
    "sheave mass": {"sheave.mass": 1.0},
    "inertia": {"sheave.inertia": 1.0},
    "friction": {"contact.friction_coefficient": 1.0},
    "radius": {"sheave.radius": 1.0},
    "pit": {"shaft.pit": 1.0},
    "offset": {"effects.attachment_offset.car": 1.0, "effects.attachment_offset.counterweight": 0.5},
    "drag": {"effects.air_drag.drag_coefficient": 1.0},
    "runout": {"effects.sheave_eccentricity.eccentricity": 1.0},
    "sway": {"effects.building_sway.amplitude": 1.0},
    "bent": {"effects.intrinsic_curvature.curvature": 1.0},
    "guides": {"effects.guide_friction.coulomb_force": 1.0},
    "slip": {"effects.bending_hysteresis.friction_moment": 1.0},
}
PRESENT = {
    "effects.sheave_eccentricity.eccentricity": 1e-3, "effects.bending_hysteresis.friction_moment": 0.5,
    "effects.bending_hysteresis.yield_curvature": 0.1,
}  # fmt: skip
ABSENT = {
    "effects.bending_hysteresis.yield_curvature": 0.1, "effects.bending_hysteresis.friction_moment": 0.0,
    "effects.building_sway.frequency": 0.3, "effects.building_sway.amplitude": 0.0,
}  # fmt: skip
DRAGGED = {"effects.air_drag.drag_coefficient": 1.1, "rope.external_damping": 0.05}
SHARES = {"drag": 1e-1, "radius": 1e-6, "pit": 1e-6, "slip": 1e-3, "sway": 1e-3, "bent": 1e-3, "guides":1e-3}
SHARE = 1e-5  # of a parameter: by so much whole runs are differenced, so that hardly a node comes to lie on the sheave or leaves it


@cache
def measured() -> Run:
    """A trip of 3 m as a measurement would have it, without values, of a sheave of 100 kg."""
    time = np.arange(0.0, 4.0, 0.02)
    trip = Trip((jerk_limited(4.0, 3.0, 0.4, np.array([0.7, 0.3, 0.5, 0.4, 0.5, 0.3, 0.5])),), 0.0, "profile")
    return Run("trip", "fit", {"sheave.mass": 100.0}, time, trip.position(time), trip, trip.mirrored(MODEL.shaft.height), {})


@cache
def sensitivities(changes: tuple[tuple[str, float], ...], names: tuple[str, ...], exact: bool = False) -> dict[str, dict[str, np.ndarray]]:
    """Derivatives along some directions at the model with changes."""
    model = with_changes(MODEL, dict(changes))
    return replay_with_sensitivities(model, measured(), CHANNELS, {name: DIRECTIONS[name] for name in names}, exact=exact)[1]


def differences(changes: dict[str, float], direction: dict[str, float], share: float) -> dict[str, np.ndarray]:
    """Derivatives along a direction by differences of whole runs: central, or from one side where a bound is in the way."""
    run, base = measured(), values_of(with_changes(MODEL, changes | measured().changes))
    values = {key: base.get(key, DECLARED[key].neutral) for key in direction}
    step = min(share * max(abs(values[key]), DECLARED[key].nominal) / abs(amount) for key, amount in direction.items())
    bounded = any(values[key] - step * amount < DECLARED[key].minimum for key, amount in direction.items())

    def moved(steps: float) -> dict[str, np.ndarray]:
        there = {key: values[key] + steps * step * amount for key, amount in direction.items()}
        return replay(with_changes(MODEL, changes), replace(run, changes=run.changes | there), CHANNELS).values

    weights = {0.0: -1.5, 1.0: 2.0, 2.0: -0.5} if bounded else {-1.0: -0.5, 1.0: 0.5}
    runs = {steps: moved(steps) for steps in weights}
    return {column: sum(weight * runs[steps][column] for steps, weight in weights.items()) / step for column in CHANNELS}


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(values**2)))


def errors(found: dict[str, np.ndarray], expected: dict[str, np.ndarray]) -> dict[str, float]:
    """Differences over the signal, both rms, by channel."""
    return {column: rms(found[column] - expected[column]) / rms(expected[column]) for column in CHANNELS}


@pytest.mark.parametrize("name", DIRECTIONS)
def test_derivatives_are_those_of_whole_runs(name: str) -> None:
    found = sensitivities(tuple(ABSENT.items()), tuple(DIRECTIONS))[name]
    expected = differences(ABSENT, DIRECTIONS[name], SHARES.get(name, 1e-5))
    left = errors(found, expected)
    ex = errors(sensitivities(tuple(ABSENT.items()), tuple(DIRECTIONS), True)[name], expected)
    print(name, 'EX', {k: f"{v:.5f}" for k, v in ex.items()})
    print(name, {k: f"{v:.5f}" for k, v in left.items()})
