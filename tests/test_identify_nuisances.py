"""What every campaign has that is no effect: clocks that disagree, a sheave that stands anyhow at the start, bad samples."""

import numpy as np
import pytest

import comprope_system
from comprope.rope.model_file import with_changes
from comprope_system.identification.comparison.compare import compare
from comprope_system.identification.comparison.nrmse import channel_error
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.diagnosis.diagnose import diagnose
from comprope_system.identification.estimation.parameter_estimates import plant_estimates
from comprope_system.identification.model_updating.baseline_fit import fit_baseline
from comprope_system.identification.prediction.plant_parameters import CLOCK, PLANT_PARAMETERS
from comprope_system.identification.prediction.replay import instrument
from comprope_system.parallel.executors import threads

from . import virtual_elevator

LATE = 0.04  # s
RUNOUT = "effects.sheave_eccentricity.eccentricity"
PHASE = "effects.sheave_eccentricity.phase"
PHASES = {"up.csv": 0.7, "down_light.csv": 2.4, "up_short.csv": -1.0}


@pytest.fixture(scope="module")
def executor():
    with threads() as ready:
        yield ready


def test_a_late_clock_is_found_and_is_no_effect(tmp_path, executor):
    """All channels come 40 ms late, which shifts the sheave's speed by several times its noise wherever the car accelerates."""
    folder = virtual_elevator.campaign(tmp_path / "late", {})
    for file, *_ in virtual_elevator.RUNS:
        lines = (folder / file).read_text().splitlines()
        table = np.genfromtxt(lines, delimiter=",", names=True)
        for name in virtual_elevator.CHANNELS:
            table[name] = np.interp(table["time"] - LATE, table["time"], table[name])
        np.savetxt(folder / file, np.column_stack([table[name] for name in table.dtype.names]), delimiter=",", header=lines[0],
                   comments="", fmt="%.5f")  # fmt: skip
    found = fit_baseline(load_campaign(folder), executor).fitted
    late = found.coefficients[[one.name for one in PLANT_PARAMETERS].index(CLOCK)]
    # A record of 9 s knows the instant to about a millisecond.
    assert abs(late - LATE) < 0.003
    assert found.chi_square < 1.2 * len(found.jacobian)


@pytest.fixture(scope="module")
def turned(tmp_path_factory):
    """A campaign in which the sheave, out of true, stands at another angle at the start of every run."""
    folder, random = virtual_elevator.campaign(tmp_path_factory.mktemp("turned"), {}), np.random.default_rng(3)
    for file, _, start, distance, changes in virtual_elevator.RUNS:
        hidden = {RUNOUT: 2e-3, PHASE: PHASES[file]}
        table = virtual_elevator.measure(file, start, distance, changes, hidden, random)
        table.to_csv(folder / file, index=False, float_format="%.5f")
    return load_campaign(folder)


@pytest.mark.parametrize("mass", [1.0, 1.43])
def test_a_rope_of_quite_another_mass_is_no_effect(tmp_path, executor, monkeypatch, mass):
    """Its swings come out of step with the model's before a record ends, from where derivatives alone do not lead back."""
    monkeypatch.setitem(virtual_elevator.PLANT, "rope.mass_per_length", mass)
    baseline = fit_baseline(load_campaign(virtual_elevator.campaign(tmp_path / "heavy", {})), executor)
    assert baseline.initial_fit.chi_square > 100.0 * len(baseline.problem.data)
    assert baseline.fitted.chi_square < 1.2 * len(baseline.problem.data)
    assert plant_estimates(baseline.campaign, baseline.fitted)["rope.mass_per_length"].value == pytest.approx(mass, rel=0.005)


def test_each_run_may_begin_with_another_angle_of_the_sheave(turned, executor):
    found = diagnose(turned, executor)
    assert found.verdict == "sheave_eccentricity"
    best = found.ranking[0].fitted
    assert best.chi_square < 1.3 * len(found.problem.data)
    assert abs(best.point.effects[RUNOUT] - 2e-3) < 5e-5
    told = {file: best.point.effects[PHASE] + own[PHASE] for file, own in best.point.shifts.items()}
    assert set(told) == {"up.csv", "down_light.csv"}  # the run held out is not fitted
    assert all(abs(np.angle(np.exp(1j * (angle - PHASES[file])))) < 0.05 for file, angle in told.items())


def test_added_the_effect_acts_in_each_run_from_its_own_angle_on(turned, executor):
    """The model file has one angle, single runs others; the size of a groove out of true is known far better than its angle."""
    found = comprope_system.add(turned, "sheave_eccentricity", executor=executor)
    fitted = [(before, run) for before, run in zip(found.before.runs, found.after.runs, strict=True) if run.role == "fit"]
    assert all(run.nrmse < 0.1 * before.nrmse for before, run in fitted)
    size = found.parameters[RUNOUT]
    assert size.value == pytest.approx(2e-3, abs=5e-5) and size.standard_error < 5e-5


def test_an_effect_is_found_on_a_rope_of_quite_another_mass(tmp_path, executor, monkeypatch):
    """Where much swings, the misfit without the effect does not tell the mass: it is found with the effect."""
    monkeypatch.setitem(virtual_elevator.PLANT, "rope.mass_per_length", 1.0)
    found = diagnose(load_campaign(virtual_elevator.campaign(tmp_path / "light", {RUNOUT: 2e-3, PHASE: 0.7})), executor)
    best = found.ranking[0].fitted
    assert found.verdict == "sheave_eccentricity" and best.chi_square < 1.2 * len(found.problem.data)
    assert best.point.effects[RUNOUT] == pytest.approx(2e-3, rel=0.03)
    assert plant_estimates(found.campaign, best)["rope.mass_per_length"].value == pytest.approx(1.0, rel=0.005)


def test_samples_far_from_their_neighbours_are_no_error_of_the_model(tmp_path, executor):
    campaign = load_campaign(virtual_elevator.campaign(tmp_path / "spiked", {}))
    clean = compare(campaign, executor)
    campaign.runs[0].values["cw_low"][[50, 200, 301]] += 0.05
    assert compare(campaign, executor).nrmse == pytest.approx(clean.nrmse, rel=0.02)


def test_a_delay_hides_no_sample_that_is_in_view():
    model = with_changes(virtual_elevator.MODEL, {"effects.sensor_delay.cw_low": -1e-6})
    time = np.arange(0.0, 1.0, 0.01)
    value = np.where((time > 0.2) & (time < 0.7), np.sin(time), np.nan)
    shown = instrument(model, "cw_low", time, value)
    assert np.array_equal(np.isfinite(shown), np.isfinite(value))
    assert np.nanmax(abs(shown - value)) < 2e-6


def test_an_error_is_that_of_the_samples_both_have():
    measured, predicted = np.sin(np.linspace(0.0, 9.0, 200)), np.sin(np.linspace(0.0, 9.0, 200)) + 0.1
    measured[20:30], predicted[100] = np.nan, np.nan
    assert channel_error(measured, predicted, 0.01) == pytest.approx(0.1 / np.nanstd(np.delete(measured, 100)), rel=1e-9)
