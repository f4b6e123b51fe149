"""Swing of the rope of a parked car in a swaying building, and the floors to avoid."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import load, with_changes
from comprope_system import cli
from comprope_system.presets import model_path
from comprope_system.vibration.modal.hanging_string import side_string
from comprope_system.vibration.sway_operation.full_simulation import simulated_amplitudes
from comprope_system.vibration.sway_operation.parked_response import Sway, parked_rope

TOWER = with_changes(load(model_path("tower50")), {"rope.element_length": 0.1})


@pytest.mark.parametrize(("car", "share"), [(5.0, 0.6), (30.0, 1.0), (45.0, 1.3)])
def test_small_swing_is_that_of_the_full_model(car: float, share: float) -> None:
    """Below, at and above the first resonance of the counterweight's side, from rest and without damping."""
    small, period = Sway(2e-4, 20.0, 0.0), share * side_string(TOWER, car, "counterweight").period()
    linear, full = parked_rope(TOWER, car).amplitudes(small, period), simulated_amplitudes(TOWER, car, small, period)
    assert linear == pytest.approx(full, rel=0.06, abs=1e-5)


def test_a_slow_building_takes_the_rope_along() -> None:
    """Far above all natural periods the rope keeps the static shape, whose distance from the leaning building is a hand value."""
    car, sway = 30.0, Sway(0.01, 400.0, 0.02)
    c = 0.5 * TOWER.sheave.mass / TOWER.rope.mass_per_length
    lengths = [height + TOWER.shaft.pit for height in (car, TOWER.shaft.height - car)]
    z = np.linspace(0.0, 1.0, 400)
    by_hand = [sway.amplitude * L / 51.5 * np.abs(np.log1p(z * L / c) / np.log1p(L / c) - z).max() for L in lengths]
    assert parked_rope(TOWER, car).amplitudes(sway, 300.0) == pytest.approx(by_hand, rel=0.1)


def test_damping_bounds_the_swing_at_resonance() -> None:
    """From rest it grows with the duration; with damping it ends at the steady amplitude."""
    car = 30.0
    parked, period = parked_rope(TOWER, car), side_string(TOWER, car, "counterweight").period()
    short, long = (parked.amplitudes(Sway(1e-3, duration, 0.0), period)[1] for duration in (30.0, 60.0))
    damped = [parked.amplitudes(Sway(1e-3, duration, 0.02), period)[1] for duration in (200.0, 400.0)]
    assert long > 1.5 * short
    assert damped[1] == pytest.approx(damped[0], rel=1e-3)


def test_the_command_writes_map_page_and_floors_to_avoid(tmp_path: Path) -> None:
    """A floor is avoided where its swing is above the limit."""
    files = {"--out": "s.csv", "--plot": "s.png", "--report": "s.html", "--json": "s.json"}
    arguments = [part for option, name in files.items() for part in (option, str(tmp_path / name))]
    asked = ["--amplitude", "10", "--period", "2.5", "--limit", "60", "--floors", "3", "--duration", "20", "--verify", "1"]
    told = CliRunner().invoke(cli.app, ["sway", "tower50", "--set", "rope.element_length=0.2", *asked, *arguments])
    assert told.exit_code == 0, told.output
    found = json.loads((tmp_path / "s.json").read_text(encoding="utf-8"))
    assert [floor["height"] for floor in found["floors"]] == [0.0, 25.0, 50.0]
    assert all(floor["avoid"] == (floor["swing"] > 0.06) for floor in found["floors"])
    assert 0 < sum(floor["avoid"] for floor in found["floors"]) < 3 or "none" in told.output
    table = pd.read_csv(tmp_path / "s.csv")
    assert len(table) == len(found["cars"]) * len(found["periods"])
    assert table["counterweight_swing"].max() == pytest.approx(np.max(found["counterweight_swing"]), rel=1e-5)
    assert (tmp_path / "s.png").stat().st_size > 10_000
    assert "parking floors to avoid" in (tmp_path / "s.html").read_text(encoding="utf-8")


def test_a_floor_has_the_swing_of_its_own_resonance_also_between_the_periods_of_the_map() -> None:
    """Whose steps are wider than a resonance of a rope with little damping."""
    parked = parked_rope(TOWER, 25.0)
    own = 2.0 * np.pi / float(parked.rates[0])
    options = comprope_system.SwayOptions(0.01, 1.03 * own, floors=3, positions=2, periods=4, damping=0.001, verify=0)
    found = comprope_system.sway(TOWER, options)
    height, swing = found.floors[1]
    assert height == 25.0
    assert swing == pytest.approx(parked.amplitudes(options.sway, own).max(), rel=1e-3)
    at = int(np.argmin(np.abs(found.cars - 25.0)))
    assert swing > 1.2 * found.swing[:, at, np.abs(found.periods / options.period - 1.0) < 0.11].max()


def test_bad_values_are_told_all_at_once() -> None:
    """One line each."""
    with pytest.raises(InputError) as refused:
        comprope_system.SwayOptions(amplitude=9.0, floors=1, duration=0.0)
    assert str(refused.value).splitlines() == [
        "amplitude = 9 m: 0.0001 to 5 m is accepted",
        "floors = 1: 2 to 200 is accepted",
        "duration = 0 s: 1 to 7200 s is accepted",
    ]


def test_a_bracket_is_reached_where_the_swing_at_its_height_is_larger() -> None:
    """Half the largest swing of a side at rest in the middle of it is reached at its middle, twice as much nowhere."""
    period, options = side_string(TOWER, 30.0, "counterweight").period(), {"amplitude": 0.01, "floors": 2, "positions": 6}
    asked = {"duration": 20.0, "periods": 4, "verify": 0, "period": period}
    parked, sway = parked_rope(TOWER, 30.0), Sway(0.01, 20.0, 0.005)
    largest = parked.amplitudes(sway, period)[1]
    middle = float(parked.heights[1][np.argmax(parked.profile(sway, period)[1])])
    assert parked.at_heights(sway, period, np.array([middle, 49.0]))[1] == pytest.approx([largest, 0.0])
    brackets = ((middle, 0.5 * largest), (middle, 4.0 * largest))
    found = comprope_system.sway(TOWER, comprope_system.SwayOptions(**options, **asked, brackets=brackets))
    near, far = found.brackets
    assert 30.0 in near.cars
    assert far.cars == ()
    assert near.swing == far.swing >= largest
    assert "the rope may catch with the car at" in found.summary()
    assert f"{1e3 * far.distance:g} mm: swing of up to" in found.summary()


def test_trips_at_two_speeds_swing_and_the_limit_tells_which_are_kept() -> None:
    """The full model, through the resonance of a side."""
    asked = {"amplitude": 0.02, "floors": 2, "positions": 2, "duration": 20.0, "periods": 2, "verify": 0}
    options = comprope_system.SwayOptions(**asked, period=2.6, limit=0.5, speeds=(2.5, 5.0))
    found = comprope_system.sway(TOWER, options)
    assert [speed for speed, _, _ in found.speeds] == [2.5, 5.0]
    swings = np.array(found.speeds)[:, 1:]
    assert 0.01 < swings.min() < swings.max() < 0.5
    assert swings[0].max() > swings[1].max()  # slower, so longer in the resonance
    assert "within 500 mm at 2.5, 5 m/s" in found.summary()


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--brackets", "60"], "brackets = 60: heights in m and distances in mm such as 60:400,80:350 are accepted"),
        (["--brackets", "60:0"], "brackets: 0 m at 60 m; a distance of 0.01 to 20 m"),
        (["--speeds", "2"], "speeds: accepted with the period of the building"),
        (["--speeds", "x", "--period", "3"], "speeds = x: numbers separated by commas are accepted"),
    ],
)
def test_bad_brackets_and_speeds_are_refused(options: list[str], sentence: str) -> None:
    told = CliRunner().invoke(cli.app, ["sway", "tower50", *options])
    assert told.exit_code != 0
    assert sentence in str(told.exception)
