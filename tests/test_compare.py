"""A model against measurements: how far off it is, where, and what is odd about the data."""

import json
from dataclasses import replace

import numpy as np
import pytest

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import dump, with_changes
from comprope_system import cli
from comprope_system.identification.comparison.compare import compare
from comprope_system.identification.comparison.data_quality import remarks
from comprope_system.identification.comparison.error_metrics import ORDERS, by_band, by_bins, by_order, sprague_geers
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.data.trip_phases import PHASES, phases
from comprope_system.parallel.executors import threads

from . import virtual_elevator


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A campaign in which nothing but the plant differs from the model."""
    return virtual_elevator.campaign(tmp_path_factory.mktemp("sound"), {})


@pytest.fixture(scope="module")
def comparison(folder):
    with threads() as executor:
        return compare(load_campaign(folder), executor)


# -- measures ----------------------------------------------------------------------------------------

TIME = np.arange(0.0, 20.0, 0.01)
WAVE = np.sin(2.0 * np.pi * 0.7 * TIME)


def test_sprague_and_geers_know_size_from_phase():
    larger = sprague_geers(WAVE, 1.2 * WAVE)
    assert larger.magnitude == pytest.approx(0.2, abs=1e-6) and larger.phase == pytest.approx(0.0, abs=1e-6)
    late = sprague_geers(WAVE, np.sin(2.0 * np.pi * 0.7 * TIME - np.pi / 10.0))
    assert late.magnitude == pytest.approx(0.0, abs=1e-3) and late.phase == pytest.approx(0.1, abs=1e-3)
    assert sprague_geers(WAVE, WAVE).combined == pytest.approx(0.0, abs=1e-7)


def test_bands_add_up_to_the_whole():
    residual = 3.0 * WAVE + np.sin(2.0 * np.pi * 3.0 * TIME)
    bands = by_band(TIME, residual)
    assert np.sqrt((bands**2).sum()) == pytest.approx(np.sqrt(np.mean(residual**2)), rel=1e-3)
    assert bands[2] == pytest.approx(3.0 / 2.0**0.5, rel=0.02) and bands[4] == pytest.approx(1.0 / 2.0**0.5, rel=0.02)


def test_an_order_spectrum_finds_what_turns():
    angle = 0.3 * TIME**2
    amplitudes = by_order(angle, 0.4 * np.cos(2.0 * angle + 0.3))
    assert ORDERS[np.argmax(amplitudes)] == pytest.approx(2.0, abs=0.051)
    assert amplitudes.max() == pytest.approx(0.4, rel=0.05)
    assert np.isnan(by_order(0.01 * TIME, WAVE)).all()  # less than a turn says nothing


def test_bins_hold_the_error_of_their_place():
    found = by_bins(TIME, np.where(TIME < 10.0, 1.0, 2.0), np.array([0.0, 10.0, 20.0, 30.0]))
    assert found[:2] == pytest.approx([1.0, 2.0]) and np.isnan(found[2])


def test_every_sample_lies_in_one_phase(comparison):
    run = comparison.campaign.runs[0]
    masks = phases(run.trip, run.time)
    assert list(masks) == list(PHASES)
    assert (np.sum(list(masks.values()), axis=0) == 1).all()
    middles = [float(run.time[masks[name]].mean()) for name in PHASES]
    assert middles == sorted(middles)
    assert np.abs(run.trip.velocity(run.time[masks["cruise"]])).min() > 0.98 * np.abs(run.trip.velocity(run.time)).max()


# -- comparison --------------------------------------------------------------------------------------


def test_a_sound_model_is_near_but_its_plant_is_off(comparison):
    """Bending stiffness and mass are a few per cent off: more than noise, far less than what the channels vary."""
    for run in comparison.runs:
        lateral = [one for one in run.channels if one.channel.quantity == "lateral_displacement"]
        assert all(0.02 < one.nrmse < 0.25 for one in lateral)
        turning = next(one for one in run.channels if one.column == "turning")
        assert turning.reduced_chi_square == pytest.approx(1.0, abs=0.25)  # the sheave turns with the car, whatever the plant
    assert comparison.reduced_chi_square > 1.5


def test_the_result_has_the_form_that_was_agreed(comparison):
    found = json.loads(json.dumps(comparison.to_json(), allow_nan=False))
    assert {"runs", "nrmse"} <= set(found)
    assert [run["role"] for run in found["runs"]] == ["fit", "fit", "validate"]
    for run in found["runs"]:
        assert {"file", "role", "channels"} <= set(run)
        for channel in run["channels"]:
            assert {"column", "nrmse", "by_phase"} <= set(channel)
            assert set(channel["by_phase"]) == set(PHASES)
    assert found["nrmse"] == pytest.approx(comparison.nrmse)


def test_the_command_prints_and_writes(capsys, folder, tmp_path):
    out, page = tmp_path / "c.json", tmp_path / "c.html"
    with pytest.raises(SystemExit) as done:
        cli.main(["compare", str(folder), "--json", str(out), "--report", str(page)])
    told, errors = capsys.readouterr()
    assert (done.value.code, errors) == (0, "")
    assert "NRMSE" in told and "up_short.csv (validate)" in told and f"written {page}" in told
    assert json.loads(out.read_text())["runs"][0]["file"] == "up.csv"
    assert '<figure class="curves"' in page.read_text() and "up_short.csv" in page.read_text()
    assert "fails most at" in told and json.loads(out.read_text())["largest_error"]["file"] in page.read_text()


def test_further_models_are_compared_with_the_same_runs(capsys, folder, comparison, tmp_path):
    stiffer = with_changes(comparison.campaign.model, {"rope.bending_stiffness": 21.2})
    dump(stiffer, tmp_path / "stiffer.toml")
    out, page = tmp_path / "c.json", tmp_path / "c.html"
    with pytest.raises(SystemExit) as done:
        cli.main(["compare", str(folder), "--model", str(tmp_path / "stiffer.toml"), "--json", str(out), "--report", str(page)])
    told, errors = capsys.readouterr()
    assert (done.value.code, errors) == (0, "") and "stiffer.toml" in told
    found = json.loads(out.read_text())
    (variant,) = found["variants"]
    with threads() as executor:
        alone = compare(replace(comparison.campaign, model=stiffer), executor)
    assert found["fit_nrmse"] == pytest.approx(comparison.fit_nrmse)
    assert variant["validate_nrmse"] == pytest.approx(alone.validate_nrmse)
    assert alone.validate_nrmse < 0.95 * comparison.validate_nrmse
    assert page.read_text().count("stiffer.toml") > 1


def test_a_further_model_without_the_sensors_of_the_campaign_is_refused(folder, comparison, tmp_path):
    dump(comparison.campaign.model.model_copy(update={"sensors": ()}), tmp_path / "blind.toml")
    with pytest.raises(InputError, match=r"blind\.toml: lacks the sensor .*cw_low"):
        comprope_system.compare(folder, models=[tmp_path / "blind.toml"])
    with pytest.raises(InputError, match="6 are compared"):
        comprope_system.compare(folder, models={str(k): tmp_path / "blind.toml" for k in range(9)})


@pytest.mark.parametrize("command", ["compare", "diagnose", "add", "improve"])
def test_bad_input_is_said_in_one_line(capsys, folder, tmp_path, command):
    effect = ["air_drag"] if command == "add" else []
    for arguments, wanted in (
        ([str(tmp_path / "nowhere"), *effect], "nowhere/campaign.toml: cannot be read"),
        ([str(folder), *effect, "--report", str(tmp_path / "page.pdf")], "page.pdf: a name that ends in .html"),
        ([str(folder), *effect, "--json", str(tmp_path)], "is a folder; give the name of a file"),
    ):
        with pytest.raises(SystemExit) as done:
            cli.main([command, *arguments])
        _, errors = capsys.readouterr()
        assert done.value.code == 2 and wanted in errors and errors.count("\n") == 1


def test_an_effect_that_is_none_is_refused_before_the_long_work(capsys, folder):
    for effect, wanted in (("air_drga", 'did you mean "air_drag"?'), ("sensor_gain.cw_lo", 'did you mean "cw_low"?')):
        with pytest.raises(SystemExit) as done:
            cli.main(["add", str(folder), effect])
        assert done.value.code == 2 and wanted in capsys.readouterr().err


# -- remarks -----------------------------------------------------------------------------------------


def told(comparison, fault) -> str:
    """What is said of the data after `fault` has been done to the values of each run."""
    campaign = comparison.campaign
    runs = tuple(replace(run, values=run.values | fault(run)) for run in campaign.runs)
    return "\n".join(remarks(replace(campaign, runs=runs), comparison.predictions))


def noisy(run, column, size):
    return run.values[column] + size * np.random.default_rng(5).standard_normal(len(run.time))


def spiky(run):
    values = run.values["car_low"].copy()
    values[[100, 200]] += 0.05
    return {"car_low": values}


def holed(run):
    values = run.values["car_low"].copy()
    values[50:90] = np.nan
    return {"car_low": values}


FAULTS = [
    (lambda run: {"cw_low": -run.values["cw_low"]}, "cw_low: anticorrelated with the model in every run"),
    (lambda run: {"cw_low": 10.0 * run.values["cw_low"]}, "near a power of ten: check its unit"),
    (lambda run: {"cw_low": 1e3 * run.values["cw_low"]}, 'its unit is probably "um", not "mm"'),
    (lambda run: {"turning": run.values["turning"] * 30.0 / np.pi}, 'its unit is probably "rpm", not "rad/s"'),
    (
        lambda run: {"cw_low": noisy(run, "cw_low", 1e-3)},
        "cw_low: noise = 0.3 mm is stated, but at rest its standard deviation is",
    ),
    (lambda run: {"car_low": run.values["car_low"] + 2e-3 * run.time}, "car_low: drifts by about"),
    (spiky, "car_low: outliers (2 in up.csv, 2 in down_light.csv, 2 in up_short.csv)"),
    (holed, "car_low: samples missing while the rope is in view of the sensor: 8.9 % in up.csv"),
    (
        lambda run: {c: np.interp(run.time - 0.06, run.time, v) for c, v in run.values.items()},
        "ms late against the car's position",
    ),
]


@pytest.mark.parametrize(("fault", "wanted"), FAULTS)
def test_what_is_odd_about_data_is_said(comparison, fault, wanted):
    assert wanted in told(comparison, fault)


def test_sound_data_need_no_remark(comparison):
    assert told(comparison, lambda run: {}) == ""


def test_one_late_channel_is_no_matter_of_clocks(comparison):
    late = told(comparison, lambda run: {"turning": np.interp(run.time - 0.06, run.time, run.values["turning"])})
    assert "clocks" not in late
