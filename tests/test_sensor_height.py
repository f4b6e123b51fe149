"""A laser that looks at another height than stated: what it shows, its derivative, and how a diagnosis calls it."""

import numpy as np
import pytest

from comprope.rope.model_file import with_changes
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.diagnosis.diagnose import diagnose
from comprope_system.identification.prediction.effect_hypotheses import instrument_hypotheses
from comprope_system.identification.prediction.replay import replay
from comprope_system.identification.prediction.replay_sensitivities import replay_with_sensitivities
from comprope_system.parallel.executors import threads

from . import virtual_elevator
from .virtual_elevator import CHANNELS, MODEL

KEY = "effects.sensor_height.cw_low"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return load_campaign(virtual_elevator.campaign(tmp_path_factory.mktemp("sound"), {})).runs[0]


def test_a_shifted_laser_shows_what_one_at_that_height_shows(run):
    shifted = replay(with_changes(MODEL, {KEY: 0.25}), run, CHANNELS).values
    there = replay(with_changes(MODEL, {"sensors[1].height": 1.25}), run, CHANNELS).values
    stated = replay(MODEL, run, CHANNELS).values
    assert all(np.array_equal(shifted[column], there[column], equal_nan=True) for column in CHANNELS)
    assert np.nanmax(np.abs(shifted["cw_low"] - stated["cw_low"])) > 5e-4  # m


@pytest.mark.parametrize("error", [0.0, 0.2])
def test_the_derivative_by_the_height_is_the_slope_of_the_rope(run, error):
    """Alone, and along with a parameter of the rope, whose own derivative it adds to."""
    model, h = with_changes(MODEL, {KEY: error}), 0.02
    higher, lower = (replay(with_changes(MODEL, {KEY: error + step}), run, CHANNELS).values for step in (h, -h))
    mass = {"rope.mass_per_length": 1.0}
    shown, by = replay_with_sensitivities(model, run, CHANNELS, {"mass": mass, "both": {**mass, KEY: 1.0}, "height": {KEY: 1.0}})
    slope = (higher["cw_low"] - lower["cw_low"]) / (2.0 * h)
    close = 0.03 * np.nanmax(np.abs(slope))
    assert by["height"]["cw_low"] == pytest.approx(slope, abs=close, nan_ok=True)
    assert by["both"]["cw_low"] - by["mass"]["cw_low"] == pytest.approx(slope, abs=close, nan_ok=True)
    assert all(not np.nan_to_num(by["height"][column]).any() for column in CHANNELS if column != "cw_low")
    plain = replay(model, run, CHANNELS).values
    assert all(np.array_equal(shown.values[column], plain[column], equal_nan=True) for column in CHANNELS)


def test_only_lasers_have_a_height():
    faults = [one.directions[0].name for one in instrument_hypotheses(CHANNELS) if one.effect == "sensor_height"]
    assert faults == ["effects.sensor_height.cw_low", "effects.sensor_height.car_low"]


def test_a_laser_at_another_height_is_found_or_said_to_look_like_a_gain(tmp_path):
    """Near the sheave the rope leaves it nearly straight, so that a height acts as a gain; half a metre up the car's side."""
    campaign = load_campaign(virtual_elevator.campaign(tmp_path / "high", {KEY: 0.4}))
    with threads() as executor:
        found = diagnose(campaign, executor)
    named = {one.hypothesis.effect: one.probability for one in found.ranking}
    assert found.kind == "instrument"
    assert named.get("sensor_height", 0.0) + named.get("sensor_gain", 0.0) > 0.9
    height = next(one for one in found.ranking if one.hypothesis.effect == "sensor_height")
    assert height.fitted.point.effects[KEY] == pytest.approx(0.4, rel=0.2)
