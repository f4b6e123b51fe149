"""Buildings that move: records of a model file, replayed by simulations."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline
from typer.testing import CliRunner

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import dump, load, with_changes
from comprope_system import cli
from comprope_system.presets import model_path
from comprope_system.simulation.building_motion.record import building_record
from comprope_system.simulation.trips.result import SimulationResult

LAST = 4.0  # s
TIMES = np.arange(0.0, LAST + 1.0, 0.02)
TOWER = with_changes(load(model_path("tower50")), {"rope.element_length": 0.1})
BUILDING = 'record = "r.csv"\ncolumns = ["ground", "top"]\nheights = [-1.5, 50.0]\nunit = "m"\n'


def model_in(folder: Path, columns: dict[str, np.ndarray], building: str = BUILDING) -> Path:
    """A model file beside a record with these columns."""
    dump(TOWER, folder / "m.toml")
    with (folder / "m.toml").open("a", encoding="utf-8") as file:
        file.write(f"\n[building]\n{building}")
    pd.DataFrame({"time": TIMES} | columns).to_csv(folder / "r.csv", index=False)
    return folder / "m.toml"


def trip(model: object) -> SimulationResult:
    """The beginning of a trip up."""
    return comprope_system.simulate(model, comprope_system.CarMotion(10.0, 14.0), duration=LAST)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def plain() -> SimulationResult:
    """The same trip in a building at rest."""
    return trip(TOWER)


def sway(period: float, amplitude: float) -> np.ndarray:
    """Displacement of the top [m], which begins from rest."""
    return amplitude * np.sin(2.0 * np.pi * TIMES / period) * np.minimum(TIMES, 1.0) ** 3


def test_a_record_of_zeros_changes_no_bit(tmp_path: Path, plain: SimulationResult) -> None:
    """Every column that a building at rest has too is the same."""
    zero = np.zeros(len(TIMES))
    moved = trip(model_in(tmp_path, {"ground": zero, "top": zero})).table
    assert (moved["base_acceleration"] == 0.0).all()
    pd.testing.assert_frame_equal(moved[list(plain.table)], plain.table, check_exact=True)


def test_a_building_that_moves_rigidly_leaves_the_rope_as_it_is(tmp_path: Path, plain: SimulationResult) -> None:
    """An offset of metres and a constant speed, to rounding."""
    moving = 1.7 + 0.3 * TIMES
    moved = trip(model_in(tmp_path, {"ground": moving, "top": moving})).table
    for name in (*plain.sensors, "sheave_displacement"):
        assert np.nanmax(np.abs(moved[name] - plain.table[name])) < 1e-8


def test_sway_of_several_modes_adds_up_while_it_is_small(tmp_path: Path, plain: SimulationResult) -> None:
    """The response to two modes at once is the sum of those to each, within a hundredth of it."""
    shapes = "shapes = [[0.0, 0.4, 1.0], [0.0, 1.0, -0.6]]\n"
    building = 'record = "r.csv"\ncolumns = ["first", "second"]\nheights = [-1.5, 25.0, 50.0]\nunit = "m"\n' + shapes
    first, second, none = sway(2.5, 2e-3), sway(0.8, 1e-3), np.zeros(len(TIMES))
    found = []
    for k, (one, other) in enumerate(((first, none), (none, second), (first, second))):
        folder = tmp_path / str(k)
        folder.mkdir()
        found.append(trip(model_in(folder, {"first": one, "second": other}, building)).table)
    for name in plain.sensors:
        one, other, both = (table[name] - plain.table[name] for table in found)
        assert np.abs(both).max() > 2e-4
        assert np.abs(both - one - other).max() < 0.01 * np.abs(both).max()


def test_sensors_and_ends_move_with_the_building(tmp_path: Path, plain: SimulationResult) -> None:
    """Ends by the record at their heights; sensors see the rope relative to the building; the balance of energy is kept."""
    top = sway(2.0, 0.05)
    result = trip(model_in(tmp_path, {"ground": np.zeros(len(TIMES)), "top": top}))
    table = result.table
    share = (table["car_position"] + 1.5) / 51.5
    expected = -share * np.interp(table["time"], TIMES, top)
    assert np.abs(table["car_lateral_displacement"] - expected).max() < 1e-4
    motion = building_record(result.model).motion  # type: ignore[union-attr]
    sensor = next(one for one in result.model.sensors if one.side == "counterweight")
    last = float(table["time"].iloc[-1])
    moved = motion.displacement(sensor.height, last)
    assert moved == pytest.approx((sensor.height + 1.5) / 51.5 * top[round(last / 0.02)], abs=1e-5)
    in_base_frame = table[sensor.name].iloc[-1] + moved
    assert abs(in_base_frame - plain.table[sensor.name].iloc[-1]) > 1e-4
    assert table["energy_residual"].abs().max() < 0.02


def test_accelerations_give_the_motion_of_the_displacements(tmp_path: Path) -> None:
    """Integrated twice, less a drift; in g, as a strong-motion instrument writes them."""
    ground = sway(0.7, 0.2)
    ground_acceleration = CubicSpline(TIMES, ground)(TIMES, 2)
    both = [{"ground": ground, "top": 1.2 * ground}]
    both.append({name: factor * ground_acceleration / 9.80665 for name, factor in (("ground", 1.0), ("top", 1.2))})
    as_acceleration = BUILDING.replace('unit = "m"', 'unit = "g"\nquantity = "acceleration"')
    motions = []
    for k, (columns, building) in enumerate(zip(both, (BUILDING, as_acceleration), strict=True)):
        folder = tmp_path / str(k)
        folder.mkdir()
        record = building_record(load(model_in(folder, columns, building)))
        assert record is not None
        motions.append(record.motion)
    at = 2.31
    assert motions[1].base_acceleration(at) == pytest.approx(motions[0].base_acceleration(at), rel=0.02)
    assert motions[1].displacement(50.0, at) == pytest.approx(motions[0].displacement(50.0, at), rel=0.05)


@pytest.mark.parametrize(
    ("columns", "building", "message"),
    [
        ({"ground": 0.0}, BUILDING, "building.record = r.csv: no column top; the header has time, ground"),
        (
            {"ground": 0.0, "top": 0.0},
            BUILDING.replace("50.0", "40.0"),
            "building.heights = -1.5 to 40 m: from the sheave's axle",
        ),
        ({"ground": 0.0, "top": 0.0}, BUILDING.replace("-1.5", "3.0"), "building.heights = 3 to 50 m: from the sheave's axle"),
        ({"ground": 0.0, "top": 0.0}, BUILDING.replace('unit = "m"\n', ""), "ground: its unit is unknown; building.unit = m, cm"),
        ({"ground": 0.0, "top": 0.0}, BUILDING.replace('"m"', '"kN"'), "building.unit = kN: no unit of a displacement"),
        ({"ground": 0.0, "top": 30.0}, BUILDING, "the building moves by 30 m relative to its base; at most 5 m is accepted"),
        ({"ground": 0.0, "top": 0.0}, BUILDING.replace('"top"', '"ground"'), "one or more different columns are accepted"),
        ({"ground": 0.0, "top": 0.0}, BUILDING.replace("[-1.5, 50.0]", "[-1.5]"), "two or more rising heights are accepted"),
        ({"ground": 0.0, "top": 0.0}, BUILDING + "start = 4.99\n", "building.start = 4.99 s: the record r.csv lasts 4.98 s"),
        ({"ground": 0.0, "top": 0.0}, BUILDING.replace('"r.csv"', '"../r.csv"'), "lies outside of the model's folder"),
        ({"ground [mm]": 0.0, "top": 0.0}, BUILDING, "the file states mm, building.unit m; one of them is accepted"),
    ],
)
def test_what_does_not_fit_is_refused_in_a_sentence(
    tmp_path: Path, columns: dict[str, float], building: str, message: str
) -> None:
    """Missing columns, another unit, a building lower than the shaft, a record that is over."""
    with pytest.raises(InputError) as refused:
        trip(model_in(tmp_path, {name: np.full(len(TIMES), value) for name, value in columns.items()}, building))
    assert message in str(refused.value)


def test_a_record_shorter_than_the_trip_is_refused(tmp_path: Path) -> None:
    """It is not taken to stand still after its end."""
    zero = np.zeros(len(TIMES))
    with pytest.raises(InputError, match=r"building.record = r.csv: ends 4.98 s after the simulation begins"):
        comprope_system.simulate(model_in(tmp_path, {"ground": zero, "top": zero}), duration=10.0)


def test_times_that_do_not_increase_are_refused(tmp_path: Path) -> None:
    """Without advice about keys that a model file does not have."""
    zero = np.zeros(len(TIMES))
    model = model_in(tmp_path, {"ground": zero, "top": zero})
    pd.DataFrame({"time": np.round(TIMES, 1), "ground": zero, "top": zero}).to_csv(tmp_path / "r.csv", index=False)
    with pytest.raises(InputError) as refused:
        trip(model)
    assert "time in row 3 must be later than the row before" in str(refused.value)
    assert "[file]" not in str(refused.value)


def test_other_commands_take_a_building_at_rest(tmp_path: Path) -> None:
    """A design or a campaign would leave the record out without a word."""
    zero = np.zeros(len(TIMES))
    with pytest.raises(InputError, match="building: accepted by `comprope simulate` alone"):
        comprope_system.design(model_in(tmp_path, {"ground": zero, "top": zero}))


def test_a_model_file_keeps_its_building(tmp_path: Path) -> None:
    """The record is named relative to the file."""
    zero = np.zeros(len(TIMES))
    model = load(model_in(tmp_path, {"ground": zero, "top": zero}))
    dump(model, tmp_path / "again.toml")
    assert 'record = "r.csv"' in (tmp_path / "again.toml").read_text(encoding="utf-8")
    assert load(tmp_path / "again.toml") == model


def test_the_example_of_three_fmus_does_what_simulate_does(tmp_path: Path) -> None:
    """Drive, building and rope in fmpy, the building from the ground's acceleration; the model replays its displacements."""
    assert CliRunner().invoke(cli.app, ["fmu", "tower50", "--out", str(tmp_path)]).exit_code == 0
    made = comprope_system.building("tower50", duration=30.0, period=1.12, damping=0.02)
    made.to_csv(tmp_path / "levels.csv")
    made.save_model(tmp_path / "m.toml", tmp_path / "levels.csv")
    ground = {"time": made.record.times, "ground_acceleration": made.record.ground_acceleration}
    pd.DataFrame(ground).to_csv(tmp_path / "ground.csv", index=False)
    script = Path(__file__).parent.parent / "docs" / "examples" / "building_trip.py"
    files = ["ElevatorDrive.fmu", "CompensationRope.fmu", "ground.csv", "trip.csv"]
    subprocess.run([sys.executable, script, *(tmp_path / name for name in files), "5"], check=True, timeout=120)
    found = pd.read_csv(tmp_path / "trip.csv")
    same = comprope_system.simulate(tmp_path / "m.toml", duration=5.0).table
    for name, tolerance in (("car_position", 1e-5), ("car_lateral_displacement", 2e-5), ("sheave_force", 0.1)):
        assert np.abs(found[name] - same[name]).max() < tolerance, name
    assert np.ptp(found["car_lateral_displacement"]) > 1e-3
