"""Clearance of the rope from walls: known shapes, a rope that bounces off a wall, a wall that moves with the building."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline
from typer.testing import CliRunner

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import load, with_changes
from comprope_system import cli
from comprope_system.presets import model_path
from comprope_system.simulation.building_motion.motion import BuildingMotion
from comprope_system.simulation.trips.clearance import Wall, clearance_of
from comprope_system.simulation.trips.rope_shapes import DEPTHS, Frame, Recording

TOWER = with_changes(load(model_path("tower50")), {"rope.element_length": 0.1})
PIT = TOWER.shaft.pit
TIMES = np.arange(0.0, 2.01, 0.05)


def recorded(amplitude: np.ndarray) -> tuple[Recording, pd.DataFrame]:
    """The car's side bows by amplitude sin(pi s), the other one hangs straight; the car rises from 30 to 32 m in 2 s."""
    frames, cars = [], 30.0 + TIMES
    for car, by in zip(cars, amplitude, strict=True):
        sides = np.array([by * np.sin(np.pi * DEPTHS), np.zeros(len(DEPTHS))])
        frames.append(Frame(np.array([car, 50.0 - car]), sides, np.zeros((2, 48)), 0.0, 0.0))
    none = np.zeros(len(TIMES))
    columns = {f"{side}_side_max_{what}": none for side in ("car", "counterweight") for what in ("displacement", "height")}
    return Recording(tuple(frames), 0.05), pd.DataFrame({"time": TIMES, "car_position": cars} | columns)


def test_a_known_shape_has_its_least_clearance_and_touches_when_it_does() -> None:
    """A half wave that grows steadily to 0.3 m beside a wall at 0.2 m."""
    recording, table = recorded(0.15 * TIMES)
    found = clearance_of(recording, table, TOWER, Wall(0.2))
    assert found.least.clearance == pytest.approx(-0.1, abs=1e-3)
    assert (found.least.side, found.least.car, found.least.time) == ("car", 32.0, 2.0)
    assert found.least.height == pytest.approx(0.5 * (32.0 - PIT), abs=0.5)
    assert found.touch is not None
    assert found.touch.time == pytest.approx(0.2 / 0.15, abs=0.05)
    middle = int(np.argmin(np.abs(found.heights - found.least.height)))
    by_car = found.margins[0, :, middle]
    assert by_car[np.isfinite(by_car)] == pytest.approx(0.2 - 0.15 * (found.cars - 30.0)[np.isfinite(by_car)], abs=0.01)
    assert np.nanmax(np.abs(found.margins[1] - 0.2)) < 1e-9


def test_a_bracket_counts_between_its_heights_alone() -> None:
    """Below the middle of the bow the clearance is larger."""
    recording, table = recorded(np.full(len(TIMES), 0.15))
    low = clearance_of(recording, table, TOWER, Wall(0.2, 0.0, 3.0))
    assert low.least.clearance == pytest.approx(0.2 - 0.15 * np.sin(np.pi * (3.0 + PIT) / (30.0 + PIT)), abs=0.01)
    assert low.touch is None
    with pytest.raises(InputError, match="clearance: no rope between 60 and 70 m"):
        clearance_of(recording, table, TOWER, Wall(0.2, 60.0, 70.0))


def test_the_building_moves_the_wall() -> None:
    """A rope that moves with the building keeps its clearance."""
    away = np.full(len(TIMES), 0.5)
    motion = BuildingMotion([-PIT, 50.0], [[0.0, 1.0]], CubicSpline(TIMES, away[:, None]), -PIT)
    recording, table = recorded(np.zeros(len(TIMES)))
    frames = []
    for frame in recording.frames:
        heights = frame.ends[:, None] + DEPTHS * (-PIT - frame.ends[:, None])
        by = motion.displacements(heights.ravel(), [0.0])[0].reshape(heights.shape) * np.array([[-1.0], [1.0]])
        frames.append(Frame(frame.ends, by, frame.arc, 0.0, 0.0))
    found = clearance_of(Recording(tuple(frames), 0.05), table, TOWER, Wall(0.2), motion)
    assert np.nanmax(np.abs(found.margins - 0.2)) < 1e-9


def test_a_rope_that_bounces_off_a_wall_touches_it_and_goes_no_further() -> None:
    """In a building in resonance; without the wall the rope would go far beyond."""
    sway = {"effects.building_sway.amplitude": 0.15, "effects.building_sway.frequency": 0.45}
    wall = {"effects.shaft_walls.stiffness": 1e5, "effects.shaft_walls.damping": 500.0, "effects.shaft_walls.distance": 0.25}
    still = comprope_system.CarMotion(30.0, 31.0)
    free, held = (comprope_system.simulate(TOWER, still, changes=sway | one, duration=12.0) for one in ({}, wall))
    beyond, bounced = free.clearance(0.25), held.clearance()
    assert beyond.least.clearance < -0.1
    assert -0.03 < bounced.least.clearance < 0.0
    assert bounced.touch is not None
    assert beyond.touch is not None
    assert bounced.touch.time == pytest.approx(beyond.touch.time, abs=0.05)
    assert bounced.least.clearance == pytest.approx(bounced.to_dataframe()["clearance"].min(), abs=0.01)


def test_the_command_prints_and_draws_the_clearance(tmp_path: Path) -> None:
    """With a wall at a distance; without one it says what is needed, before it simulates."""
    arguments = ["simulate", "tower50", "--set", "rope.element_length=0.1", "--time", "2", "--clearance", str(tmp_path / "c.png")]
    told = CliRunner().invoke(cli.app, [*arguments, "--wall", "300", "--report", str(tmp_path / "page.html")])
    assert told.exit_code == 0, told.output
    assert "clearance from a wall at 300 mm: least" in told.output
    assert (tmp_path / "c.png").stat().st_size > 10_000
    assert "clearance from a wall at 300 mm" in (tmp_path / "page.html").read_text(encoding="utf-8")
    with pytest.raises(InputError, match="the distance of the wall is needed: --wall MM"):
        CliRunner().invoke(cli.app, arguments, catch_exceptions=False)
