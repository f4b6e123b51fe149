"""From a model that fails to one that does not, on an elevator whose sheave is badly fitted.

The elevator is measured on a finer mesh, at another step and with a plant a few per cent off; its groove runs 2 mm out of
true, unknown to the model. It fails here; this is missing; it is added; the error falls on the run that was not fitted.
"""

import json
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from fmpy import read_model_description

import comprope_system
from comprope.errors import InputError
from comprope.rope.effects import REGISTRY
from comprope.rope.model_file import load
from comprope_system import cli
from comprope_system.identification.comparison.compare import compare
from comprope_system.identification.comparison.error_metrics import ORDERS
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.diagnosis.experiment_design import ProposedRun, best_two_fits
from comprope_system.identification.diagnosis.held_out_validation import to_json, validate
from comprope_system.identification.estimation.parameter_estimates import effect_estimates, standard_error_scale
from comprope_system.identification.model_updating import add_effect
from comprope_system.identification.model_updating import stepwise_selection as steps
from comprope_system.identification.model_updating.baseline_fit import fit_baseline
from comprope_system.identification.model_updating.updated_model import campaign_parameters, file_comment
from comprope_system.identification.prediction.effect_hypotheses import combine, hypotheses_of_effect
from comprope_system.identification.prediction.model_effects import shape_hypotheses
from comprope_system.identification.prediction.plant_parameters import PLANT_PARAMETERS
from comprope_system.identification.residuals.residual_correlation import residual_correlations
from comprope_system.identification_results.reporting.pages.verdict_card import verdict_card
from comprope_system.identification_results.reporting.texts.effect_descriptions import meaning
from comprope_system.identification_results.result.diagnosis import DiagnosisResult
from comprope_system.identification_results.result.updating import AddResult
from comprope_system.parallel.executors import threads

from . import virtual_elevator

HIDDEN = {"effects.sheave_eccentricity.eccentricity": 2e-3, "effects.sheave_eccentricity.phase": 0.7}


@pytest.fixture(scope="module")
def executor():
    with threads() as ready:
        yield ready


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    return load_campaign(virtual_elevator.campaign(tmp_path_factory.mktemp("worn"), HIDDEN))


@pytest.fixture(scope="module")
def comparison(campaign, executor):
    return compare(campaign, executor)


@pytest.fixture(scope="module")
def improved(campaign, executor):
    """Diagnose, add, diagnose again, and remove what is not needed."""
    return comprope_system.improve(campaign, executor=executor)


@pytest.fixture(scope="module")
def validated(improved, executor):
    """The first diagnosis, judged on all runs."""
    return validate(improved.selection.diagnoses[0], executor)


@pytest.fixture(scope="module")
def better(improved):
    """The model with what the diagnosis found."""
    return improved.updated


# -- it fails here -----------------------------------------------------------------------------------


def test_the_model_fails_on_the_axle_once_a_turn(comparison):
    for run in comparison.runs:
        axle = next(one for one in run.channels if one.column == "axle")
        assert axle.nrmse > 0.9 and axle.reduced_chi_square > 100.0
        assert axle.by_phase["rest"] < 0.2 * axle.by_phase["cruise"]  # nothing turns while the car stands
        whole = (ORDERS > 0.8) & (ORDERS < 4.0)
        assert ORDERS[whole][np.argmax(axle.orders[whole])] == pytest.approx(1.0, abs=0.16)


# -- this is missing ---------------------------------------------------------------------------------


def test_the_diagnosis_names_what_is_missing(validated):
    found = to_json(validated)
    assert (found["verdict"], found["verdict_kind"]) == ("sheave_eccentricity", "known_effect")
    top = found["ranking"][0]
    assert top["effect"] == "sheave_eccentricity" and top["probability"] > 0.95 and not top["estimated"]
    assert top["parameters"]["eccentricity"] == pytest.approx(2e-3, rel=0.05)
    assert top["parameters"]["phase"] == pytest.approx(0.7, abs=0.05)
    assert top["error_after"] < 0.1 * top["error_before"]
    assert top["validate_error_after"] < 0.1 * top["validate_error_before"]


def test_the_result_has_the_form_that_was_agreed(validated):
    found = json.loads(json.dumps(to_json(validated), allow_nan=False))
    assert {"verdict", "verdict_kind", "ranking", "indistinguishable"} <= set(found)
    keys = {"effect", "probability", "error_before", "error_after", "validate_error_before", "validate_error_after", "parameters"}
    assert all(keys <= set(entry) for entry in found["ranking"])
    names = [entry["effect"] for entry in found["ranking"]]
    assert len(set(names)) == len(names)
    assert sum(found["probabilities"].values()) == pytest.approx(1.0)


@pytest.mark.slow
def test_with_the_effect_ruled_out_none_of_the_known_explains_it(campaign, executor):
    """As if eccentricity were in nobody's library."""
    stages = []
    found = comprope_system.diagnose(
        campaign, without=["sheave_eccentricity"], executor=executor, progress=lambda *stage: stages.append(stage)
    )
    assert (found.verdict, found.verdict_kind) == (None, "unknown_effect") and found.probabilities["unknown"] > 0.9
    assert "sheave_eccentricity" not in found.probabilities
    assert len(stages) > 5 and all(isinstance(text, str) and (done, total) == (0, 0) for text, done, total in stages)
    assert found.next_runs and found.residual_force is not None
    assert "none of the known effects explains the residual" in found.headline()
    assert found.residual_force.sentence()[:20] in found.summary() and "Next run to measure" in found.summary()
    assert {"residual_force", "residual_correlations", "clues", "next_runs"} <= set(checked(found))


def test_without_the_effect_the_residual_points_to_the_sheave(validated):
    """What is left is locked to the sheave's angle, once a turn."""
    first = residual_correlations(validated.diagnosis.campaign, validated.refitted.predictions)[0]
    assert first.coordinate == "the sheave's angle" and first.peak == pytest.approx(1.0, abs=0.05)
    assert first.share > 0.3


def test_the_fits_to_tell_apart_are_the_hidden_effect_and_the_one_that_leaves_least_beside_it(validated):
    found = validated.diagnosis
    (best, first), (second, other) = best_two_fits(found)
    left = {one.hypothesis.effect: one.fitted.chi_square for one in found.ranking if one.refined}
    left["nothing missing"] = found.baseline.chi_square
    assert best == "sheave_eccentricity" and first.chi_square == left.pop(best) < 1.3 * len(found.problem.data)
    assert other.chi_square == left[second] == min(left.values()) and other.chi_square > 10.0 * first.chi_square


# -- it is added, and the error falls ----------------------------------------------------------------


def test_added_the_error_falls_on_the_run_that_was_not_fitted(better):
    assert better.after.fit_nrmse < 0.1 * better.before.fit_nrmse
    assert better.after.validate_nrmse < 0.1 * better.before.validate_nrmse
    assert better.refitted.validate_nrmse > 0.5 * better.before.validate_nrmse  # the plant alone cannot do it


def test_values_come_with_their_uncertainty(better):
    size = better.effects["effects.sheave_eccentricity.eccentricity"]
    assert size.low < size.value < size.high
    assert size.value == pytest.approx(2e-3, rel=0.03) and size.standard_error < 1e-4
    stiffness = better.plant["rope.bending_stiffness"]
    assert stiffness.before == 20.0 and stiffness.value == pytest.approx(21.2, rel=0.05)


def test_the_new_model_file_stands_for_itself(better, executor, tmp_path):
    """Read back, it gives the same errors with the campaign's clock, and its first lines say where its numbers come from."""
    from comprope.rope.model_file import dump

    dump(better.model, tmp_path / "new.toml", file_comment(better))
    text = (tmp_path / "new.toml").read_text()
    assert text.startswith("# elevator.toml with sheave_eccentricity, fitted to the campaign") and "±" in text
    model = load(tmp_path / "new.toml")
    again = compare(replace(better.before.campaign, model=model), executor, campaign_parameters(better.fitted))
    assert again.validate_nrmse == pytest.approx(better.after.validate_nrmse, rel=1e-9)


def test_what_is_there_is_fitted_again_and_not_added_twice(better, executor):
    campaign = replace(better.before.campaign, model=better.model)
    baseline = fit_baseline(campaign, executor)
    values = baseline.fitted.point.effects
    assert values["effects.sheave_eccentricity.eccentricity"] == pytest.approx(2e-3, rel=0.03)
    assert baseline.fitted.chi_square < 1.1 * better.fitted.chi_square


def test_the_selection_ends_there_and_tells_the_share_of_each_step(improved):
    selection = improved.selection
    assert selection.final_diagnosis.kind == "adequate"
    assert [one.name for one in selection.steps] == ["as it stands", "plant refitted", "sheave_eccentricity"]
    shares = {name: (fit, held) for name, fit, held in selection.error_reductions()}
    assert sum(fit for fit, _ in shares.values()) == pytest.approx(1.0)
    assert shares["sheave_eccentricity"][1] > 0.8  # on the run that was not fitted
    assert selection.removed == () and [one.effect for one in selection.removals] == ["sheave_eccentricity"]
    assert not selection.removals[0].removable
    json.dumps(selection.to_json(), allow_nan=False)


# -- results of the public functions -----------------------------------------------------------------


def checked(result):
    """The JSON of a result whose text, table and notebook view are there."""
    table = result.to_dataframe()
    assert len(table) and result.headline() in " ".join(result.summary().split())
    assert result._repr_html_().count("<tr") >= min(len(table), 12) and type(result).__name__ in repr(result)
    return json.loads(json.dumps(result.to_json(), allow_nan=False))


def test_an_improved_model_is_one_result(improved, tmp_path):
    found = checked(improved)
    assert found["effects"] == improved.effects == ["sheave_eccentricity"] and found["verdict_kind"] == "adequate"
    assert found["bought"] == found["error_reductions"] and found["pruned"] == found["removed"] == []
    assert all(one["misfit_per_datum"] == one["reduced_chi_square"] for one in found["steps"])
    assert list(improved.to_dataframe()["step"]) == [one.name for one in improved.steps]
    improved.save_model(tmp_path / "new.toml")
    assert load(tmp_path / "new.toml") == improved.model
    improved.save_fmus(tmp_path / "fmus")
    assert {path.name for path in (tmp_path / "fmus").iterdir()} == {"CompensationRope.fmu", "ElevatorDrive.fmu"}
    described = read_model_description(str(tmp_path / "fmus" / "CompensationRope.fmu")).modelVariables
    (start,) = (float(one.start) for one in described if one.name == "effects.sheave_eccentricity.eccentricity")
    assert start == improved.model.effects.sheave_eccentricity.eccentricity
    improved.save_html(tmp_path / "page.html")
    assert "Stepwise selection" in (tmp_path / "page.html").read_text("utf-8")


def test_an_added_effect_is_one_result(better, tmp_path):
    result = AddResult(better)
    found = checked(result)
    assert found["parameters"]["eccentricity"] == result.parameters["effects.sheave_eccentricity.eccentricity"].value
    assert found["reduced_chi_square"] == found["misfit_per_datum"] == result.reduced_chi_square
    table = result.to_dataframe().set_index("file")
    before, after = table.loc["up_short.csv", ["nrmse_before", "nrmse_after"]]
    assert after == result.after.runs[2].nrmse < 0.1 * before
    result.save_html(tmp_path / "page.html")
    assert "Estimates" in (tmp_path / "page.html").read_text("utf-8")


def test_a_diagnosis_is_one_result(validated, tmp_path):
    found = DiagnosisResult(validated, (), 0.1, None, ())
    plain = checked(found)
    assert found.verdict == plain["verdict"] == "sheave_eccentricity" and found.verdict_kind == "known_effect"
    assert found.headline().startswith("Missing effect: sheave_eccentricity, probability ")
    assert plain["reduced_chi_square"] == plain["misfit_per_datum"]
    assert all(one["reduced_chi_square"] == one["misfit_per_datum"] for one in plain["ranking"])
    assert found.to_dataframe()["effect"][0] == "sheave_eccentricity"
    assert found.plant_parameters["rope.bending_stiffness"].value == pytest.approx(21.2, rel=0.05)
    assert "comprope add" in found.summary()
    found.save_html(tmp_path / "page.html")
    assert "Plant parameters" in (tmp_path / "page.html").read_text("utf-8")


def test_the_card_of_a_verdict_says_what_the_result_says(validated):
    card = verdict_card(validated, ())
    fitted = validated.diagnosis.ranking[0].fitted
    estimate = effect_estimates(fitted, standard_error_scale(fitted, len(validated.diagnosis.problem.data)))
    one = estimate["effects.sheave_eccentricity.eccentricity"]
    assert (card.kind, card.title, card.texts) == ("Missing effect", "Sheave eccentricity", [meaning("sheave_eccentricity")])
    ((name, value, interval),) = card.values  # no phase
    assert (name, value) == ("eccentricity", f"{float(f'{1e3 * one.value:.3g}'):g} mm")
    low, high = (float(text.split()[0]) for text in interval.removeprefix("95 %: ").split(" to "))
    assert (low, high) == pytest.approx((1e3 * one.low, 1e3 * one.high), rel=6e-3) and low < 1e3 * one.value < high
    facts = dict(card.facts)
    others = {name: p for name, p in validated.diagnosis.probabilities.items() if name != "sheave_eccentricity"}
    assert facts["runner-up"].startswith(max(others, key=others.get).replace("_", " ").replace("unknown", "an unknown effect"))
    assert f"{100.0 * validated.best.fit_nrmse:.3g} %" in facts["error"]
    assert facts["next run to measure"].startswith("none") and "sheave eccentricity" not in facts["could not have been seen"]
    assert card.command.startswith("comprope ") and str(validated.diagnosis.campaign.folder) in card.command


def test_the_card_leads_to_the_curves_that_betray_the_effect(validated):
    shown = verdict_card(validated, ()).evidence
    assert 0 < len(shown) <= 3 and len({text for text, _ in shown}) == len(shown)
    columns = [one.column for one in validated.best.runs[0].channels]
    for text, target in shown:
        run = validated.best.runs[target.group]
        assert text.startswith(f"{columns[target.panel]} in {run.file}, {target.span}: ")
        without, with_it = (float(one) for one in re.findall(r"([\d.]+) %", text))
        channel = validated.refitted.runs[target.group].channels[target.panel]
        assert without == pytest.approx(100.0 * channel.by_phase[target.span.replace(" ", "_")], rel=6e-3)
        assert with_it < 0.5 * without
    assert "turning" not in shown[0][0]  # the sheave turns as before; its axle moves


def test_a_fit_begins_where_it_is_told(campaign, executor, better, monkeypatch):
    def refused(*_):
        raise AssertionError("a fit that is told where to begin needs no screening")

    monkeypatch.setattr(add_effect, "promising_frequencies", refused)
    monkeypatch.setattr(add_effect, "best_initial_guess", refused)
    size, phase = "effects.sheave_eccentricity.eccentricity", "effects.sheave_eccentricity.phase"
    found = comprope_system.add(campaign, "sheave_eccentricity", start={size: 1e-3, phase: 0.3}, executor=executor)
    assert found.parameters[size].value == pytest.approx(better.effects[size].value, rel=1e-2)
    assert found.parameters[size].standard_error > 0.0
    assert found.after.fit_nrmse == pytest.approx(better.after.fit_nrmse, rel=1e-2)


@pytest.mark.parametrize(
    ("effect", "start", "said"),
    [
        ("air_drag", "effects.air_drag.drag_coefficient=-1", "--start: effects.air_drag.drag_coefficient = -1"),
        ("air_drag", "effects.guide_friction.coulomb_force=1", "values of effects.air_drag.PARAMETER are accepted"),
        ("air_drag", "drag", "--start drag: KEY=VALUE is accepted"),
        ("sensor_gain.axle", "effects.sensor_gain.turning=1.1", "values of effects.sensor_gain.axle are accepted"),
    ],
)
def test_a_start_that_cannot_be_is_refused_in_a_sentence(campaign, effect, start, said):
    with pytest.raises(InputError) as error:
        comprope_system.add(campaign, effect, start=[start])
    assert said in str(error.value) and "\n" not in str(error.value)


def test_the_card_of_an_unknown_effect_names_the_next_run(validated):
    probabilities = {name: 0.01 * p for name, p in validated.diagnosis.probabilities.items()} | {"unknown": 0.9, "air_drag": 0.08}
    unknown = replace(validated.diagnosis, verdict=None, kind="unknown_effect", probabilities=probabilities)
    card = verdict_card(replace(validated, diagnosis=unknown), (ProposedRun(1.5, 0.0, 8.0, 1.0, 7.0),))
    facts = dict(card.facts)
    assert (card.kind, card.values) == ("Unknown effect", []) and card.title.startswith("None of the known effects")
    assert facts["probability"] == "0.90" and facts["runner-up"].startswith("air drag: probability 0.08")
    assert facts["next run to measure"].startswith("up from 0 m to 8 m at 1 m/s with 1.5 times")
    assert card.command == f"comprope diagnose {unknown.campaign.folder} --report diagnosis.html"


def test_an_effect_with_its_shape_freed_is_one_step(monkeypatch):
    """Hysteresis with its yield curvature fitted as well stands as two parts in the hypothesis and is added once."""
    effect = hypotheses_of_effect(REGISTRY["bending_hysteresis"], ())[0]
    whole = combine(effect, *shape_hypotheses((effect,), 9.0))
    coefficients = np.arange(len(PLANT_PARAMETERS) + 2.0)
    own = [float(one) for one in coefficients[len(PLANT_PARAMETERS) :]]
    best = SimpleNamespace(hypothesis=whole, coefficients=coefficients, effect_coefficients=own)
    found = SimpleNamespace(ranking=[SimpleNamespace(fitted=best)])
    added = []
    monkeypatch.setattr(steps, "fit_with_effect", lambda baseline, new, start, known, search: added.append((new, start)))
    assert [name for name, _ in steps._add_each(None, found, None, lambda _: None)] == ["bending_hysteresis"]
    ((new, start),) = added
    assert new.parts == whole.parts and np.array_equal(start, coefficients)


# -- and an elevator in which nothing is hidden -----------------------------------------------------------


def test_a_sound_elevator_is_called_adequate(capsys, tmp_path):
    """Its plant is off as in the other elevator, which is no reason to see an effect."""
    folder = virtual_elevator.campaign(tmp_path / "sound", {})
    out = tmp_path / "d.json"
    with pytest.raises(SystemExit) as done:
        cli.main(["diagnose", str(folder), "--json", str(out), "--report", str(tmp_path / "d.html"), "--jobs", "1"])
    told, errors = capsys.readouterr()
    assert (done.value.code, errors) == (0, "")
    found = json.loads(out.read_text())
    assert found["verdict"] is None and found["verdict_kind"] == "adequate"
    assert "Nothing is missing" in told and "Next command" not in told
    page = (tmp_path / "d.html").read_text("utf-8")
    assert '<p class="title">Nothing is missing</p>' in page and "next command" not in page
