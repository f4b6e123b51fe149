"""Design: the swaying rope against its equation of motion, sensors, the least sheave, and the command."""

import json

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import load
from comprope_system import cli
from comprope_system.presets import model_path
from comprope_system.sheave_design.building_sway import BuildingSway, parked_departures, worst_parked
from comprope_system.sheave_design.sensor_placement import choose_sensors
from comprope_system.sheave_design.trip_envelopes import _at_heights, floor_heights, trips_between
from comprope_system.sheave_design.workflow import _least_mass
from comprope_system.vibration.modal.hanging_string import side_string
from comprope_system.vibration.reduced_model.string_dynamics import string_parameters
from comprope_system.vibration.reduced_model.swing import READ_POSITIONS, ReducedModel

TOWER = load(model_path("tower50"))
CASE = ReducedModel(string_parameters(TOWER), 50.0, 1.5)


def finite_differences(sway: BuildingSway, length: float, count: int = 200) -> np.ndarray:
    """The farthest departure from the building at PLACES, by a string of `count` pieces integrated in time."""
    rope, ds = CASE.rope, length / count
    s, half = np.linspace(0.0, length, count + 1), (np.arange(count) + 0.5) * ds
    tension = (rope.weight + rope.mass_per_length * rope.gravity * half) / rope.mass_per_length
    top, rate = sway.amplitude * length / 51.5, 2.0 * np.pi / sway.period

    def motion(t: float, z: np.ndarray) -> np.ndarray:
        y, v = np.zeros(count + 1), np.zeros(count + 1)
        y[1:-1], v[1:-1] = z[: count - 1], z[count - 1 :]
        y[-1] = top * np.sin(rate * t)
        return np.concatenate([v[1:-1], np.diff(tension * np.diff(y) / ds) / ds])

    start = np.concatenate(
        [np.zeros(count - 1), top * rate * s[1:-1] / length]
    )  # the building sets out swaying, and the rope with it
    times = np.arange(0.0, sway.duration, 0.1)
    found = solve_ivp(motion, (0.0, times[-1]), start, t_eval=times, rtol=1e-7, atol=1e-9).y[: count - 1]
    relative = found - np.outer(s[1:-1] / length, top * np.sin(rate * times))
    return np.array([np.interp(READ_POSITIONS, s[1:-1] / length, one) for one in np.abs(relative.T)]).max(axis=0)


@pytest.mark.parametrize("period", [2.0, 4.5])
def test_the_closed_form_of_a_swaying_rope_is_its_equation_of_motion(period: float) -> None:
    sway = BuildingSway(0.02, period, 12.0)
    wanted = finite_differences(sway, 41.5)
    assert parked_departures(CASE, sway, 10.0)["counterweight"] == pytest.approx(wanted, abs=0.02 * wanted.max())


def test_the_rope_swings_most_where_its_period_is_the_sway_s() -> None:
    cars = np.linspace(0.0, 25.0, 26)
    period = side_string(TOWER, 12.0).period()
    swing, car = worst_parked(CASE, BuildingSway(0.01, period, 60.0), cars)
    assert car == 12.0
    assert swing > 3.0 * max(float(one.max()) for one in parked_departures(CASE, BuildingSway(0.01, period, 60.0), 0.0).values())


def test_trips_between_floors_leave_out_mirror_images() -> None:
    assert trips_between(floor_heights(10.0, 3)) == [(0.0, 5.0), (0.0, 10.0), (5.0, 0.0)]
    found = trips_between(floor_heights(50.0, 6))
    assert len(found) == 15  # of 30
    assert len({*found, *((50.0 - a, 50.0 - b) for a, b in found)}) == 30


def test_sensors_are_where_every_occasion_is_seen() -> None:
    departures = np.array([[1.0, 0.0, 0.9, 0.0], [0.0, 2.0, 0.0, 1.0], [0.0, 0.0, 0.4, 0.4]])
    assert choose_sensors(departures, 2).places == (1, 2)
    assert choose_sensors(departures, 2).share == pytest.approx(0.9)
    assert choose_sensors(departures, 3).share == 1.0


def test_the_least_mass_is_the_one_from_which_on_all_keep_the_limit() -> None:
    scanned = [{"mass": mass, "swing": 1e-3 * swing} for mass, swing in ((10.0, 20.0), (20.0, 4.0), (40.0, 8.0), (80.0, 2.0))]
    assert _least_mass(scanned, "swing", "swing_limit", 4.0) == pytest.approx(40.0 * 2.0**0.5)
    assert _least_mass(scanned, "swing", "swing_limit", 30.0) == 10.0
    with pytest.raises(
        InputError, match=r"swing_limit = 1 mm: 2.00 mm or more is accepted; that is the swing even with a sheave of 80 kg"
    ):
        _least_mass(scanned, "swing", "swing_limit", 1.0)


def test_a_tiny_design_writes_its_page(capsys, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("comprope_system.sheave_design.workflow.MASS_RATIOS", np.array([0.4, 1.0, 2.5]))
    monkeypatch.setattr("comprope_system.sheave_design.workflow.TOLERANCE", 0.3)
    changes = [*("--set", "rope.element_length=0.1"), *("--set", "solver.step=0.01"), *("--set", "shaft.height=12")]
    target = [
        "--limit",
        4,
        "--floors",
        3,
        "--sway-period",
        2,
        "--sway-amplitude",
        5,
        "--wall",
        100,
        "--jobs",
        1,
        "--out",
        tmp_path,
    ]
    with pytest.raises(SystemExit) as done:
        cli.main([str(one) for one in ("design", "tower50", *changes, *target)])
    assert (done.value.code or 0) == 0
    assert capsys.readouterr().out.startswith("smallest sheave mass for 4 mm: ")
    result = json.loads((tmp_path / "result.json").read_text())
    mass, swings = result["mass"], dict(map(tuple, result["full"]))
    assert swings[mass] <= 4e-3
    assert len(result["sensors"]["places"]) == 4
    trip, sway = result["clearances"]
    assert (trip["case"], sway["case"]) == ("worst trip", "sway, parked")
    assert 0.05 < trip["clearance"] < 0.1 and sway["clearance"] < 0.1
    assert {"design.html", "resonance_own.png", "resonance_least.png", "design_mass.png"} <= {
        one.name for one in tmp_path.iterdir()
    }
    again = comprope_system.design(  # from the sweeps' results in the same folder
        "tower50",
        comprope_system.DesignOptions(0.004, 3, comprope_system.BuildingSway(0.005, 2.0, 60.0), wall=0.1),
        changes={"rope.element_length": 0.1, "solver.step": 0.01, "shaft.height": 12.0},
        checkpoint=tmp_path / "runs.jsonl",
    )
    assert json.loads(json.dumps(again.to_json(), allow_nan=False)) == result
    assert again.sheave_mass == again.new_model.sheave.mass == mass and again.model.sheave.mass == result["own_mass"]
    assert list(again.to_dataframe()["sheave_mass"]) == [one["mass"] for one in result["scanned"]]
    assert again.headline() == again.summary().splitlines()[0] and "<table" in again._repr_html_()
    assert capsys.readouterr() == ("", "")


def test_departures_at_fixed_heights_are_read_between_places_and_nought_beyond_the_rope() -> None:
    length = np.array([10.0, 20.0])
    departure = np.array([READ_POSITIONS, 2.0 * READ_POSITIONS])
    found = _at_heights(departure, length, np.array([5.0, 9.0, 15.0]))
    assert found == pytest.approx(np.array([[0.5, 0.9, 0.0], [0.5, 0.9, 1.5]]))
