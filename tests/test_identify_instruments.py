"""Faults of instruments and of the files are named as such, not fitted away by the rope."""

from types import SimpleNamespace

import pytest

from comprope_system.identification.comparison.data_quality import unit
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.data.runs import Channel
from comprope_system.identification.diagnosis.diagnose import diagnose
from comprope_system.identification.diagnosis.held_out_validation import fitted_gains, implausible_parameters, validate
from comprope_system.identification.estimation.model_score import prior_cost
from comprope_system.parallel.executors import threads

from . import virtual_elevator


@pytest.fixture(scope="module")
def executor():
    with threads() as ready:
        yield ready


@pytest.mark.parametrize(
    ("effect", "value", "told"),
    [
        ("sensor_gain", -1.0, "its sign is probably wrong"),
        pytest.param("sensor_gain", 0.1, 'its unit is probably "cm", not "mm"', marks=pytest.mark.slow),
        ("sensor_delay", 0.12, None),  # s, beside a clock that is fitted as well
        ("sensor_drift", 4e-4, "drifts by about"),  # m/s: 3.6 mm over a record, 12 times the noise
    ],
)
def test_a_fault_of_one_channel_is_the_instruments(tmp_path, executor, effect, value, told):
    key = f"effects.{effect}.cw_low"
    campaign = load_campaign(virtual_elevator.campaign(tmp_path / "fault", {key: value}))
    found = diagnose(campaign, executor)
    assert (found.verdict, found.kind) == (effect, "instrument")
    best = found.ranking[0]
    # Noise of 0.3 mm leaves a gain uncertain by a per cent or two, a drift by less.
    assert best.hypothesis.parameters(best.fitted.effect_coefficients)[key] == pytest.approx(value, rel=0.05)
    assert told is None or any(told in one for one in validate(found, executor).remarks)


@pytest.mark.parametrize(
    ("gain", "told"),
    [
        (0.101, 'axle: 0.101 times the amplitude of the model; its unit is probably "cm", not "mm"'),
        (980.0, 'axle: 980 times the amplitude of the model; its unit is probably "um", not "mm"'),
        (1e-5, "axle: 1e-05 times the amplitude of the model, near a power of ten: check its unit"),
        (0.9, None),
        (2.3, None),
    ],
)
def test_a_gain_that_a_verdict_has_fitted_tells_the_unit(gain, told):
    """Also of a channel with so much noise that the runs alone would not agree on its gain."""
    channels = {"axle": Channel(column="axle", quantity="sheave_displacement", unit="mm")}
    fitted = SimpleNamespace(effect_coefficients=[0.5])
    best = SimpleNamespace(hypothesis=SimpleNamespace(parameters=lambda x: {"effects.sensor_gain.axle": gain}), fitted=fitted)
    found = fitted_gains(SimpleNamespace(verdict="sensor_gain", ranking=[best]))
    record = SimpleNamespace(channel=channels["axle"], gain=lambda: (3e4, 1.0))  # what the runs agree on does not count
    assert list(unit([record], found)) == ([told] if told else [])
    assert fitted_gains(SimpleNamespace(verdict="air_drag", ranking=[best])) == {}


def test_a_load_cell_that_shows_too_little_is_no_lighter_sheave(tmp_path, executor, monkeypatch):
    """A sheave lighter than its data sheet fits as well, with a rope lighter and limper in proportion."""
    monkeypatch.setitem(
        virtual_elevator.CHANNELS, "weight", Channel(column="weight", quantity="sheave_force", unit="N", noise=3.0)
    )
    folder = virtual_elevator.campaign(tmp_path / "weak", {"effects.sensor_gain.weight": 0.87})
    campaign = load_campaign(folder)
    found = diagnose(campaign, executor)
    assert found.baseline.chi_square < 1.2 * len(found.problem.data)
    assert prior_cost(found.baseline.coefficients) > prior_cost(found.ranking[0].fitted.coefficients) + 7.0
    assert (found.verdict, found.kind) == ("sensor_gain", "instrument")
    assert found.ranking[0].fitted.point.effects["effects.sensor_gain.weight"] == pytest.approx(0.87, rel=0.01)
    unexplained = diagnose(campaign, executor, without=("sensor_gain",))
    assert unexplained.kind == "unknown_effect"
    assert implausible_parameters(unexplained)[0][:2] == ("sheave.mass", pytest.approx(-0.13, abs=0.01))
    assert implausible_parameters(found) == []
