"""A force that no effect of the library expresses is found at its place, with its size and what it follows."""

import json

import numpy as np
import pytest

from comprope_system.identify import figures, replay, texts
from comprope_system.identify.campaign import load_campaign
from comprope_system.identify.fit import refine
from comprope_system.identify.hypotheses import NUISANCES
from comprope_system.identify.jobs import threads
from comprope_system.identify.plain import plain
from comprope_system.identify.point import Point, gathered, submit
from comprope_system.identify.problem import pose
from comprope_system.identify.residual_force import residual_force
from comprope_system.identify.residual_force_solve import estimate, prior_root

from . import virtual_lift

KICK, WAVE = 4e-3, 3.5  # m: how far and at which distances rails push the car
TORQUE = 8.0  # N m


def found_in(folder, hidden):
    """The residual force in a campaign, of the model with its plant refitted."""
    campaign = load_campaign(virtual_lift.campaign(folder, hidden))
    runs, start = campaign.of_role("fit"), np.zeros(len(NUISANCES))
    with threads() as executor:
        problem = pose(campaign, runs, executor, gathered(runs, submit(campaign, runs, Point(), executor)))
        return campaign, residual_force(problem, refine(problem, None, start, Point()))


@pytest.fixture(scope="module")
def pushed(tmp_path_factory):
    """The car's end sways with the car's position."""
    plain_paths = replay._paths

    def swayed(model, run, grid):
        paths, k = plain_paths(model, run, grid), 2.0 * np.pi / WAVE
        (x, v, a), wave = paths[:, 0].T, k * paths[:, 0, 0]
        begun = k * x[0]
        paths[:, 1, 0] += KICK * (np.sin(wave) - np.sin(begun))
        paths[:, 1, 1] += KICK * k * v * np.cos(wave)
        paths[:, 1, 2] += KICK * k * (a * np.cos(wave) - k * v**2 * np.sin(wave))
        return paths

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(virtual_lift, "replay", lambda *args: _with(swayed, args))
        return found_in(tmp_path_factory.mktemp("pushed"), {})


def _with(paths, args):
    """A replay in which the ends go other ways."""
    with pytest.MonkeyPatch.context() as inner:
        inner.setattr(replay, "_paths", paths)
        return replay.replay(*args)


@pytest.fixture(scope="module")
def braked(tmp_path_factory):
    """The sheave's bearing resists, as if bearing friction were in nobody's library."""
    return found_in(tmp_path_factory.mktemp("braked"), {"effects.bearing_friction.coulomb_torque": TORQUE})


def test_a_push_on_the_cars_end_is_found_there(pushed):
    campaign, force = pushed
    best, second = force.suspects[:2]
    assert best.place.quantity == "car_end_out"
    assert best.share > 0.6 and second.share < best.share - 0.1
    # Its motion is about KICK / sqrt(2); a static part is not seen, since lasers count from rest.
    for run in campaign.of_role("fit"):
        course = best.courses[run.file]
        z = -run.trip.position(course.time)
        true = -KICK * (np.sin(2 * np.pi * z / WAVE) - np.sin(2 * np.pi * z[0] / WAVE))
        assert np.std(course.value - true) < 0.4 * np.std(true)


def test_a_torque_on_the_sheave_is_found_there(braked):
    campaign, force = braked
    best, second = force.suspects[:2]
    assert best.place.quantity == "sheave_torque"
    assert best.share > 0.6 and second.share < best.share - 0.1
    for run in campaign.of_role("fit"):
        course = best.courses[run.file]
        cruise = np.abs(run.trip.velocity(course.time)) > 1.0
        assert np.abs(course.value[cruise]).mean() == pytest.approx(TORQUE, rel=0.2)


def test_what_it_follows_is_told(pushed, braked):
    assert "the car's position" in [one.coordinate for one in pushed[1].clues[:3]]
    assert "the car's velocity" in [one.coordinate for one in braked[1].clues[:3]]
    for campaign, force in (pushed, braked):
        assert force.suspects[0].place.name[2:] in force.told() and "%" in force.told()
        told = json.loads(json.dumps(plain(force.to_json()), allow_nan=False))
        assert [one["share"] for one in told] == sorted((one["share"] for one in told), reverse=True)
        assert told[0]["locked_to"] and {"place", "share", "size", "unit", "courses"} <= set(told[0])
        assert len(texts.force_table(force).rows) == len(told)
        assert figures.force_bars(force).axes and len(figures.force_courses(campaign, force).axes) == 4


def test_the_estimate_of_a_known_course():
    """White noise on a smooth course through a known response: the course comes back, and free columns explain nothing."""
    random, count, n = np.random.default_rng(3), 40, 800
    response, other = random.standard_normal((2, n, count))
    course = prior_root(count, 3.0) @ random.standard_normal(count)
    r = response @ course + random.standard_normal(n)
    fold = np.arange(n) // 20 % 5
    rows, plant = np.ones((1, n), bool), np.zeros((n, 1))
    right = estimate([response], plant, r, rows, fold)
    wrong = estimate([other], plant, r, rows, fold)
    assert right.missed < 1.2 * n  # noise alone would leave n
    assert np.corrcoef(right.courses[0], course)[0, 1] > 0.9
    assert wrong.missed > 0.9 * float(r @ r)
