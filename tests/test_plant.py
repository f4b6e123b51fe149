"""The virtual tower behind the diagnosis's scores: it agrees with the library where nothing is hidden, and every cause shows."""

import json
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comprope.rope.effects import REGISTRY
from comprope.rope.model_file import load
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.prediction.replay import replay

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

import plant_check
import score_campaigns
from plant import campaign as plants
from plant import campaign_files
from plant.causes import CAUSES
from plant.simulate import excitation_of_trip, simulate
from plant.sites import SITES, TOWER50, Run
from plant.tower import Tower
from plant.trip import trip

SMALL = {"height": 15.0, "element": 0.04}  # a tower that rides in a third of a second
LOW = replace(TOWER50, runs={"up_nominal": Run(0.0, 11.0, 1.0), "up_short": Run(1.0, 12.0, 0.75)})
SHORT = replace(LOW, runs={"up_short": LOW.runs["up_short"]})
PHYSICAL = [name for name, cause in CAUSES.items() if cause.kind in ("known", "outside", "instrument")]
FILES = [name for name, cause in CAUSES.items() if cause.kind == "data"]


def rows(plan, causes):
    return plants.measured(plan, *plants.simulate_run(plan, "up_short", causes), causes)


@pytest.fixture(scope="module")
def plain():
    cache = {}

    def of(plan):
        if not cache:
            cache.update(rows(plan, {}))
        return cache

    return of


def small(name):
    return replace(plants.draw_plan(7, (name,), 1.0, LOW), plant=SMALL)


def test_without_causes_it_agrees_with_the_library(tmp_path, monkeypatch):
    simulated, simulate_run = [], plants.simulate_run
    monkeypatch.setattr(plants, "simulate_run", lambda *args: simulated.append(simulate_run(*args)) or simulated[-1])
    site = replace(LOW, runs={"up_nominal": LOW.runs["up_nominal"]})
    plan = replace(plants.draw_plan(1, ("nothing",), site=site), plant={"element": 0.02})
    plants.write(plan, tmp_path)
    measured = load_campaign(tmp_path)
    run = measured.runs[0]
    ((true, _),) = simulated  # without the noise of the instruments
    found = replay(measured.model, run, measured.channels).values
    for name in ("cw_low", "cw_mid", "car_low"):
        apart = (found[name] - np.nanmean(found[name][:300])) - (true[name] - true[name][:300].mean())
        # 0.02 to 0.03 mm at 1 cm; nodes of 2 cm make the sheave a polygon, which costs as much again, and the encoder's noise too
        assert np.sqrt(np.nanmean(apart**2)) < 8e-5
    assert np.abs(found["sheave_w"] - true["omega"]).max() < 0.01  # the encoder's noise, seen through the recovered trip


def test_at_rest_it_carries_what_hangs_on_it():
    p = Tower()
    true = simulate(p, excitation_of_trip(p, np.zeros(3), np.array([[5.0, 0.0, 0.0]] * 3)), {}, 2)
    weight = p.mass_per_length * 9.81
    ends = true["car_tension"][0] + true["counterweight_tension"][0]
    assert true["force"][0] == pytest.approx(p.sheave_mass * 9.81, rel=1e-6)
    # Each end's tension acts at the middle of its last element, half an element's weight (0.06 N) below the end.
    assert ends == pytest.approx(p.sheave_mass * 9.81 + weight * (p.rope_length - p.element), abs=0.05)
    difference = true["counterweight_tension"][0] - true["car_tension"][0]
    assert difference == pytest.approx(weight * (p.height - 2.0 * 5.0), rel=1e-3)  # stretch moves the axle by less than that


def test_a_trip_keeps_its_limits_and_arrives():
    time, motion = trip(38.0, 0.0, TOWER50.limits, 0.004, 2)
    assert motion[0, 0] == 38.0 and motion[-1, 0] == pytest.approx(0.0, abs=1e-9)
    assert np.abs(motion[:, 1]).max() == pytest.approx(2.5) and np.abs(motion[:, 2]).max() == pytest.approx(0.8)
    assert np.gradient(motion[:, 0], time) == pytest.approx(motion[:, 1], abs=1e-5)  # second order in the step: j h^2 / 6 = 2e-6
    with pytest.raises(ValueError, match="does not reach"):
        trip(0.0, 5.0, TOWER50.limits, 0.004, 2)


@pytest.mark.parametrize("name", PHYSICAL)
def test_every_cause_shows_when_it_is_large(name, plain):
    plan = small(name)
    shift = plants.shifted(LOW, rows(plan, plan.causes), plain(plan))
    assert max(shift.values()) > 2.0  # times the noise; drag shows least in so low a tower, 2.7, all others more than 3


# How the written rows of a fault differ: (its quantities, column hit, rows without noise, rows without fault, rows with fault).
def _drifts(by, column, clean, sound, faulty):
    expected = by["per_minute"] * LOW.channels[column].scale * clean["time"] / 60.0
    expected[np.isnan(sound[column])] = np.nan
    assert faulty[column] - sound[column] == pytest.approx(expected, abs=1e-9, nan_ok=True)


def _has_the_other_sign(by, column, clean, sound, faulty):
    assert faulty[column] - sound[column] == pytest.approx(-2.0 * clean[column], abs=1e-9, nan_ok=True)


def _has_another_unit(by, column, clean, sound, faulty):
    assert faulty[column] - sound[column] == pytest.approx((by["factor"] - 1.0) * clean[column], abs=1e-9, nan_ok=True)


def _is_sampled_unevenly(by, column, clean, sound, faulty):
    interval = clean["time"][1] - clean["time"][0]
    moved = np.abs(faulty["time"] - clean["time"]) / interval
    assert 0.9 * by["jitter"] < moved.max() <= by["jitter"] * (1.0 + 1e-9)  # of hundreds of uniform draws
    for name, noise in LOW.noise.items():
        apart = faulty[name] - np.interp(faulty["time"], clean["time"], clean[name])
        assert np.nanstd(apart) == pytest.approx(noise, rel=0.15)  # over a thousand samples: read at the times written


def _has_gaps(by, column, clean, sound, faulty):
    interval, longest = clean["time"][1] - clean["time"][0], 0
    for name in LOW.channels:
        lost = np.isnan(faulty[name]) & ~np.isnan(sound[name])  # beside the times at which the sensor sees no rope
        assert lost.sum() <= 2 * (by["seconds"] / interval + 1)
        assert np.array_equal(faulty[name][~lost], sound[name][~lost], equal_nan=True)
        longest = max(longest, lost.sum())
    assert longest >= by["seconds"] / interval - 1
    assert np.array_equal(faulty["car_position"], sound["car_position"])


def _has_outliers(by, column, clean, sound, faulty):
    for name, noise in LOW.noise.items():
        far = np.abs(faulty[name] - sound[name])[~np.isnan(sound[name])]
        count, size = by["share"] * len(far), by["times_noise"] * noise
        assert abs(np.count_nonzero(far) - count) < 4.0 * np.sqrt(count)  # four standard deviations
        assert 0.2 * size * (1.0 - 1e-9) <= far[far > 0.0].min() <= far.max() <= size * (1.0 + 1e-9)


def _is_late(by, column, clean, sound, faulty):
    for name in LOW.channels:
        late = np.interp(clean["time"] - by["seconds"], clean["time"], clean[name])
        assert faulty[name] - sound[name] == pytest.approx(late - clean[name], abs=1e-9, nan_ok=True)
        assert np.nanmax(np.abs(late - clean[name])) > 0.0
    assert np.array_equal(faulty["car_position"], sound["car_position"])


def _is_stated_wrongly(by, column, clean, sound, faulty):
    assert all(np.array_equal(faulty[name], sound[name], equal_nan=True) for name in sound)


FAULTS = {
    "sensor_drift": _drifts, "wrong_sign": _has_the_other_sign, "wrong_unit": _has_another_unit, "gaps": _has_gaps,
    "uneven_sampling": _is_sampled_unevenly, "outliers": _has_outliers, "clock_offset": _is_late,
    "wrong_noise": _is_stated_wrongly,
}  # fmt: skip


def test_every_fault_of_data_has_its_test():
    assert set(FAULTS) == set(FILES)


@pytest.mark.parametrize("name", FAULTS)
def test_the_written_rows_have_the_fault_that_was_drawn(name, plain):
    plan = small(name)
    clean = plain(plan)
    true = {channel.source: clean[column] / channel.scale for column, channel in LOW.channels.items()} | {"time": clean["time"]}

    def written(causes):
        rows = plants.measured(plan, true, clean["car_position"], causes)
        return plants.noisy(replace(plan, causes=causes), rows, np.random.default_rng(0))

    FAULTS[name](plan.causes[name], plan.column, clean, written({"nothing": {}}), written(plan.causes))


def test_a_wrong_noise_is_stated_and_no_other(tmp_path):
    plan = small("wrong_noise")
    ratio = plan.causes["wrong_noise"]["stated_over_true"]
    campaign_files.describe(tmp_path, LOW, 1, plants.stated_noise(plan))
    channels = tomllib.loads((tmp_path / "campaign.toml").read_text())["channels"]
    stated = {one["column"]: one["noise"] for one in channels}
    assert stated == pytest.approx({column: ratio * noise for column, noise in LOW.noise.items()}, rel=1e-3)
    assert ratio != pytest.approx(1.0, abs=0.1)
    assert plants.stated_noise(small("gaps")) == 1.0


def test_the_same_seed_gives_the_same_campaign():
    assert plants.random_plan(5) == plants.random_plan(5) != plants.random_plan(6)
    kinds = {plants.random_plan(seed).kind for seed in range(60)}
    assert kinds == set(plants.KINDS)


@pytest.mark.parametrize("site", SITES.values(), ids=SITES)
def test_a_site_can_be_measured(site, tmp_path):
    campaign_files.describe(tmp_path, site, 1, 1.0)
    model = load(tmp_path / f"{site.name}.toml")
    assert (model.shaft.height, model.sheave.mass) == (site.tower.height, site.tower.sheave_mass)
    assert {sensor.name: sensor.height for sensor in model.sensors} == {name: high for name, (_, high) in site.sensors.items()}
    for run in site.runs.values():
        _, motion = trip(run.start, run.stop, site.limits, 0.004, site.every)
        assert motion[-1] == pytest.approx([run.stop, 0.0, 0.0], abs=1e-9)  # the record may end a little after the rest
        ends = {-1.0: motion[0, 0], 1.0: site.tower.height - motion[0, 0]}
        assert all(height < ends[side] for side, height in site.sensors.values())  # in view at rest
    for name, cause in CAUSES.items():
        plan = plants.draw_plan(1, (name,), site=site)
        assert (plan.column in site.channels) if cause.quantities else plan.column is None


@pytest.mark.slow
def test_the_office_building_agrees_with_the_library(tmp_path):
    site = replace(SITES["office28"], runs={"part": replace(SITES["office28"].runs["part"], role="fit")})
    plan = replace(plant_check.COARSE, site=site)
    plants.write(plan, tmp_path)
    measured = load_campaign(tmp_path)
    rows, _ = plant_check.driven(plan, measured.runs[0])
    found = plant_check.replayed(site, measured, measured.runs[0], rows)
    for column, noise in site.noise.items():
        # with nodes of 1 cm up to 0.2 times the noise; of 2 cm, up to 0.26 times the noise away from those
        assert np.sqrt(np.nanmean((found[column] - rows[column]) ** 2)) < 0.4 * noise


def test_heights_of_causes_go_with_the_shaft():
    low, high = (plants.draw_plan(1, ("brush",), site=SITES[name]).causes["brush"] for name in ("tower50", "high120"))
    assert high["brush_height"] == pytest.approx(2.4 * low["brush_height"]) and high["brush_side"] == low["brush_side"]


def test_what_the_library_knows_is_called_as_the_library_calls_it():
    known = {cause.effect or name for name, cause in CAUSES.items() if cause.kind == "known"}
    assert known <= {name for name, effect in REGISTRY.items() if effect.hypothesis}
    outside = {cause.effect or name for name, cause in CAUSES.items() if cause.kind == "outside"}
    assert not outside & set(REGISTRY)
    truth = {"kind": "known", "causes": {"brush": {}}, "effects": {"rope_brush": {}}}
    assert score_campaigns.first(truth, SAID | {"verdict": "rope_brush"}) and not score_campaigns.first(truth, SAID)


SAID = {"verdict": "a", "verdict_kind": "known_effect", "indistinguishable": [["a", "b"]], "ranking": []}


@pytest.mark.parametrize(
    ("kind", "causes", "said", "first", "group"),
    [
        ("known", {"a": {}}, SAID, True, True),
        ("known", {"b": {}}, SAID, False, True),
        ("known", {"c": {}}, SAID, False, False),
        ("pair", {"a": {}, "c": {}}, SAID, True, True),
        ("outside", {"d": {}}, SAID, False, False),
        ("outside", {"d": {}}, {"verdict": None, "verdict_kind": "unknown_effect"}, True, True),
        ("nothing", {"nothing": {}}, {"verdict": None, "verdict_kind": "adequate"}, True, True),
        ("nothing", {"nothing": {}}, {}, False, False),
    ],
)
def test_a_verdict_is_held_against_the_truth(kind, causes, said, first, group):
    truth = {"kind": kind, "causes": causes}
    right = score_campaigns.first(truth, said)
    assert (right, right or score_campaigns.grouped(truth, said)) == (first, group)


def test_the_probability_is_that_of_the_verdict():
    shares = {"adequate": 0.1, "unknown": 0.2, "a": 0.7}
    assert score_campaigns.stated({"verdict": None, "verdict_kind": "unknown_effect", "probabilities": shares}) == 0.2
    assert score_campaigns.stated(SAID | {"ranking": [{"effect": "a", "probability": 0.7}], "probabilities": shares}) == 0.7
    assert score_campaigns.stated({}) is None


def test_a_wrong_sign_must_be_told():
    truth = {"kind": "data", "causes": {"wrong_sign": {}}, "column": "cw_mid"}
    sound = {"verdict": None, "verdict_kind": "adequate", "remarks": []}
    assert not score_campaigns.told(truth, sound, "")
    assert score_campaigns.told(truth, sound | {"remarks": ["cw_mid: it looks as if its sign were wrong"]}, "")
    assert score_campaigns.told(truth, {}, "CAMPAIGN: cw_mid has the wrong sign")


def test_the_truth_stands_beside_the_campaign(tmp_path):
    plan = replace(small("guide_friction"), site=SHORT)
    plants.write(plan, tmp_path)
    truth = json.loads((tmp_path / "truth.json").read_text())
    assert truth["site"] == "tower50" and truth["kind"] == "known"
    assert truth["causes"]["guide_friction"] == {"coulomb_force": 80.0}
    assert load(tmp_path / "tower50.toml").rope.bending_stiffness == 20.0
    assert score_campaigns.campaigns([tmp_path]) == [tmp_path.resolve()]


def test_noise_of_filtered_instruments_has_the_variance_of_white_noise_and_its_correlation() -> None:
    white = np.random.default_rng(1).normal(size=100000)
    found = plants.filtered(white, 0.8)
    assert np.std(found) == pytest.approx(1.0, abs=0.02)
    assert np.corrcoef(found[1:], found[:-1])[0, 1] == pytest.approx(0.8, abs=0.01)
    assert plants.filtered(white, 0.0) is white
