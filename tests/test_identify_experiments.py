"""Proposed experiments: when one is proposed, which runs are considered, and how they are ranked."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.data.outliers import outliers
from comprope_system.identification.diagnosis import experiment_design
from comprope_system.identification.diagnosis.experiment_design import (
    best_two_fits,
    candidate_runs,
    is_inconclusive,
    rank_candidate_runs,
)
from comprope_system.identification.prediction.parameter_point import ParameterPoint, run_at_point
from comprope_system.identification.prediction.replay import replay
from comprope_system.identification.settings import EXPERIMENTS, WHITENING
from comprope_system.parallel.executors import threads

from . import virtual_elevator

ECCENTRIC = ParameterPoint(effects={"effects.sheave_eccentricity.eccentricity": 2e-3, "effects.sheave_eccentricity.phase": 0.7})
PLAIN = ParameterPoint()


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    return load_campaign(virtual_elevator.campaign(tmp_path_factory.mktemp("experiments"), {}))


def diagnosis(campaign, *fits, baseline=(PLAIN, 900.0)):
    """A diagnosis of fits (effect, point, chi-square, on the full model), as far as the proposal of experiments reads it."""
    ranking = [
        SimpleNamespace(
            hypothesis=SimpleNamespace(effect=name), fitted=SimpleNamespace(point=point, chi_square=left), refined=refined
        )
        for name, point, left, refined in fits
    ]
    without = SimpleNamespace(point=baseline[0], chi_square=baseline[1])
    return SimpleNamespace(campaign=campaign, ranking=ranking, baseline=without)


@pytest.mark.parametrize(
    ("kind", "probabilities", "expected"),
    [
        ("known_effect", {"air_drag": 0.951, "unknown": 0.049}, False),
        ("known_effect", {"air_drag": 0.949, "unknown": 0.051}, True),
        ("instrument", {"sensor_gain": 0.6, "sensor_delay": 0.4}, True),
        ("instrument", {"sensor_gain": 0.99, "sensor_delay": 0.01}, False),
        ("adequate", {"adequate": 0.5, "air_drag": 0.5}, False),
        ("unknown_effect", {"unknown": 1.0, "air_drag": 0.0}, True),
    ],
)
def test_an_experiment_is_proposed_for_a_doubtful_verdict_and_for_an_unknown_effect(kind, probabilities, expected):
    assert is_inconclusive(SimpleNamespace(kind=kind, probabilities=probabilities)) is expected


def test_the_fits_to_be_told_apart_are_the_two_best_on_the_full_model(campaign):
    one, two = ("air_drag", PLAIN, 300.0, True), ("sheave_damper", PLAIN, 200.0, True)
    screened_only = ("bearing_friction", PLAIN, 100.0, False)
    assert [name for name, _ in best_two_fits(diagnosis(campaign, one, two, screened_only))] == ["sheave_damper", "air_drag"]
    assert [name for name, _ in best_two_fits(diagnosis(campaign, one, screened_only))] == ["air_drag", "nothing missing"]
    assert best_two_fits(diagnosis(campaign, screened_only)) is None


def test_candidate_runs_are_all_combinations_within_what_the_elevator_has_shown(campaign):
    """Weights, directions, distances and speeds; ends, speeds and accelerations as in the measured runs."""
    found = candidate_runs(campaign)
    ends = [run.trip.position(run.time) for run in campaign.runs]
    lowest, highest = min(one.min() for one in ends), max(one.max() for one in ends)
    fastest = max(np.abs(run.trip.velocity(run.time)).max() for run in campaign.runs)
    largest = max(np.abs(run.trip.acceleration(run.time)).max() for run in campaign.runs)
    assert len(found) == 3 * 2 * 2 * 2
    assert len({(one.weight, one.start, one.end, one.speed) for one, _ in found}) == len(found)
    assert {one.weight for one, _ in found} == {0.5, 1.0, 1.5}
    assert sum(one.end > one.start for one, _ in found) == len(found) // 2
    # 0.9 of the shaft is more than the measured runs have covered.
    distances = sorted(abs(one.end - one.start) for one, _ in found)
    assert distances[:12] == pytest.approx([0.4 * 14.0] * 12) and distances[12:] == pytest.approx([highest - lowest] * 12)
    for proposal, run in found:
        # The virtual elevator has a sheave of 120 kg; weight and inertia change together only where the campaign changes both.
        assert run.changes == {"sheave.mass": pytest.approx(proposal.weight * 120.0)}
        moving = np.abs(run.trip.velocity(run.time))
        assert run.car_position[0] == pytest.approx(proposal.start) and run.car_position[-1] == pytest.approx(proposal.end)
        assert moving.max() == pytest.approx(proposal.speed, rel=1e-3) and proposal.speed <= fastest * (1.0 + 1e-12)
        assert np.abs(run.trip.acceleration(run.time)).max() <= largest * (1.0 + 1e-9)
        assert lowest - 1e-9 <= run.car_position.min() and run.car_position.max() <= highest + 1e-9
        assert run.time[moving > 1e-6].min() == pytest.approx(2.0, abs=0.1) and run.time[-1] - run.time[moving > 1e-6].max() > 5.8
        counterweight = run.counterweight.position(run.time)
        assert np.allclose(counterweight, 14.0 - run.car_position)


def whitened_distance(campaign, run, first, second):
    """Root mean square of L^-1 (difference of bin means), with C = L L' written out for each channel."""
    total = count = 0.0
    width = max(WHITENING.bin_width, (run.time[-1] - run.time[0]) / 500)
    bins = ((run.time - run.time[0]) / width).astype(int)
    for column, channel in campaign.channels.items():
        a, b, noise = first[column], second[column], channel.noise * channel.scale
        good = np.isfinite(a) & np.isfinite(b)
        good[good] = ~outliers(a[good], noise)
        used = np.unique(bins[good])
        difference = np.array([np.mean((a - b)[good & (bins == k)]) for k in used])
        size = np.array([np.sum(good & (bins == k)) for k in used])
        slow = max(0.002 * np.std(a[good]), 0.15 * noise)
        covariance = slow**2 * np.exp(-np.abs(np.subtract.outer(used, used)) * width / 0.5) + np.diag(noise**2 / size)
        covariance += 1e-3 * noise**2 * np.eye(len(used))
        if channel.reference == "rest":
            covariance += noise**2 / np.sum(run.rest)
        total += difference @ np.linalg.solve(covariance, difference)
        count += len(used)
    return (total / count) ** 0.5


def test_runs_are_ranked_by_the_whitened_difference_of_both_fits(campaign, monkeypatch):
    """The distance is that of the definition, a fit has none from itself, and a weight that no rope allows is left out."""
    few = replace(EXPERIMENTS, weights=(0.5, 1.5, 1e9), distances=(0.9,), speeds=(1.0,))
    monkeypatch.setattr(experiment_design, "EXPERIMENTS", few)
    with threads() as executor:
        found = rank_candidate_runs(diagnosis(campaign, ("sheave_eccentricity", ECCENTRIC, 200.0, True)), executor)
        same = rank_candidate_runs(diagnosis(campaign, ("sheave_eccentricity", PLAIN, 200.0, True)), executor)
        none = rank_candidate_runs(diagnosis(campaign), executor)
    assert sorted(one.weight for one in found) == [0.5, 0.5, 1.5, 1.5] and none == []
    assert [one.distance for one in found] == sorted((one.distance for one in found), reverse=True)
    assert [one.distance for one in same] == [0.0] * 4
    runs = {(one.weight, one.start): run for one, run in candidate_runs(campaign)}
    for one in (found[0], found[-1]):
        run = runs[one.weight, one.start]
        a, b = (
            replay(campaign.model, run_at_point(campaign.model, run, point), campaign.channels).values
            for point in (ECCENTRIC, PLAIN)
        )
        assert one.distance == pytest.approx(whitened_distance(campaign, run, a, b), rel=1e-6)
    assert found[-1].distance > 1.0  # 2 mm of runout moves the axle by forty times its noise
    assert found[0].to_json()["distance"] == found[0].distance
    way = "up" if found[0].end > found[0].start else "down"
    assert found[0].sentence().startswith(f"{way} from {found[0].start:.3g} m to {found[0].end:.3g} m")
