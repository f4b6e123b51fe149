"""Where derivatives alone mislead: another mass of the rope, a resonance, a frequency between those tried, friction."""

import numpy as np
import pytest

from comprope.rope.effects import REGISTRY
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.diagnosis.diagnose import diagnose
from comprope_system.identification.diagnosis.linear_screening import screen_at_other_masses
from comprope_system.identification.estimation.effect_responses import one_step_away
from comprope_system.identification.estimation.gauss_newton import evaluate
from comprope_system.identification.estimation.mass_search import search_rope_mass
from comprope_system.identification.estimation.parameter_estimates import plant_estimates
from comprope_system.identification.model_updating.baseline_fit import fit_baseline
from comprope_system.identification.prediction.effect_hypotheses import combine, hypotheses_of_effect, instrument_hypotheses
from comprope_system.identification.prediction.model_effects import shapes_of
from comprope_system.identification.prediction.parameter_point import ParameterPoint
from comprope_system.identification.prediction.plant_parameters import PLANT_PARAMETERS
from comprope_system.parallel.executors import threads

from . import virtual_elevator

MASS = [one.name for one in PLANT_PARAMETERS].index("rope.mass_per_length")
LIGHT = 1.0  # kg/m, of a rope that the model has 1.2 of
RUNOUT, PHASE = "effects.sheave_eccentricity.eccentricity", "effects.sheave_eccentricity.phase"
GAIN = "effects.sensor_gain.cw_low"
HIDDEN = {RUNOUT: 2e-3, PHASE: 0.7, GAIN: 1.1}


@pytest.fixture(scope="module")
def executor():
    with threads() as ready:
        yield ready


@pytest.fixture(scope="module")
def baseline(tmp_path_factory, executor):
    """A light rope, a groove that runs 2 mm out of true, and a laser that shows a tenth too much."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(virtual_elevator.PLANT, "rope.mass_per_length", LIGHT)
        folder = virtual_elevator.campaign(tmp_path_factory.mktemp("far"), HIDDEN)
    return fit_baseline(load_campaign(folder), executor)


def test_an_effect_promises_more_from_the_mass_that_the_rope_has(baseline):
    """From the mass of the data sheet its trace is out of step with what is measured."""
    looks = screen_at_other_masses(baseline.problem, ParameterPoint(), baseline.initial_fit)
    assert looks[0].hypothesis.effect == "sheave_eccentricity"
    assert np.log(LIGHT / 1.2) == pytest.approx(looks[0].start[MASS], abs=0.06)
    assert looks[0].chi_square < 0.1 * baseline.fitted.chi_square
    assert looks == sorted(looks, key=lambda one: one.penalised_chi_square)
    assert len({one.hypothesis.effect for one in looks}) == len(looks)


def test_two_effects_at_once_are_brought_into_step(baseline):
    """Both at their true size, on a rope of the data sheet's mass: another mass, and little else, takes all that is left."""
    runout = hypotheses_of_effect(REGISTRY["sheave_eccentricity"], ())[0]
    gain = next(one for one in instrument_hypotheses(baseline.campaign.channels) if one.directions[0].name == GAIN)
    share = HIDDEN[RUNOUT] / runout.directions[0].changes[RUNOUT]
    there = [share * np.cos(HIDDEN[PHASE]), share * np.sin(HIDDEN[PHASE]), 0.1 / gain.directions[0].changes[GAIN]]
    initial_fit = evaluate(
        baseline.problem, combine(runout, gain), np.array([*np.zeros(len(PLANT_PARAMETERS)), *there]), ParameterPoint()
    )
    found = search_rope_mass(baseline.problem, initial_fit, ParameterPoint())
    assert initial_fit.chi_square > 50.0 * len(baseline.problem.data)
    assert found.chi_square < 1.3 * len(baseline.problem.data)
    assert plant_estimates(baseline.campaign, found)["rope.mass_per_length"].value == pytest.approx(LIGHT, rel=0.01)


def test_of_two_effects_that_look_alike_both_are_fitted(tmp_path, executor):
    """Dry friction that holds the sheave nearly still looks like a damper; its linear look is far too poor to be worth a fit."""
    campaign = load_campaign(virtual_elevator.campaign(tmp_path / "dry", {"effects.guide_friction.coulomb_force": 60.0}))
    found = diagnose(campaign, executor)
    fitted = {one.hypothesis.effect: one for one in found.ranking if one.refined}
    assert {"guide_friction", "sheave_damper"} <= set(fitted)
    assert found.verdict == "guide_friction"
    assert fitted["guide_friction"].fitted.chi_square < fitted["sheave_damper"].fitted.chi_square


def test_what_oscillates_is_stepped_by_little():
    """At its typical size a sway near the rope's own frequency swings it by metres; what rubs does little until it is large."""
    sway, friction = (
        hypotheses_of_effect(REGISTRY["building_sway"], (0.3,))[0],
        hypotheses_of_effect(REGISTRY["bearing_friction"], ())[0],
    )
    amplitude, torque = "effects.building_sway.amplitude", "effects.bearing_friction.coulomb_torque"
    size = sway.directions[0].changes[amplitude]
    assert [point.effects[amplitude] for point in one_step_away(ParameterPoint(), sway)] == pytest.approx(
        [0.1 * size, 0.1 * size]
    )
    assert one_step_away(ParameterPoint(), friction)[0].effects[torque] == friction.directions[0].changes[torque]


@pytest.mark.parametrize("longest", [9.0, 40.0])
def test_a_frequency_may_move_by_a_period_over_a_run(longest):
    """So far it reaches between those that are tried, and no further down, where a slow sway is another effect's drift."""
    key = "effects.building_sway.frequency"
    (shape,) = shapes_of(hypotheses_of_effect(REGISTRY["building_sway"], (0.3,))[0], longest)
    (direction,) = shape.directions
    assert direction.changes[key] * direction.lower == pytest.approx(max(-1.0 / longest, -0.3), rel=0.2)
    assert direction.changes[key] * direction.upper >= 1.0 / longest
