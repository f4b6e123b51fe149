"""Drive and rope together: as FMUs and directly the same numbers, and errors in the FMU's own words."""

import shutil
import tempfile
from pathlib import Path

import pytest

from comprope.errors import InputError, SimulationError
from comprope.rope.model_file import load, with_changes
from comprope_system import presets
from comprope_system.presets.inputs import load_drive
from comprope_system.simulation.cosim import fmu_cache
from comprope_system.simulation.cosim.fmu_cache import NamedFmus
from comprope_system.simulation.cosim.fmu_participant import FmuParticipant
from comprope_system.simulation.trips.elevator import driven_elevator
from comprope_system.simulation.trips.timing import Timing
from comprope_system.simulation.trips.trip_simulation import simulate

# A coarse rope on a short trip: what is tested is the coupling, not the rope.
COARSE = {"rope.element_length": 0.2, "solver.step": 0.005, "shaft.height": 12.0}
TRIP = {"shaft": {"height": 12.0}, "trip": {"start_position": 1.0, "destination": 2.0, "start_time": 0.0}}


@pytest.fixture(scope="module")
def model():
    return with_changes(load(presets.model_path("tower50")), COARSE)


def trip(model, direct=True, step=0.02, duration=2.0, coupling="two-way"):
    with driven_elevator(model, load_drive(None, TRIP), direct) as elevator:
        return simulate(elevator, [one.name for one in model.sensors], Timing(duration, step, coupling)).table


@pytest.fixture(scope="module")
def reference(model):
    return trip(model)


def test_fmus_and_models_give_the_same_numbers(model, reference):
    table = trip(model, direct=False)
    assert list(table) == list(reference)
    # One code on one machine; only the compiler's choices in two processes could differ, and they do not.
    assert table.equals(reference)


def test_nothing_is_left_behind(model, monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    drive = load_drive(None, TRIP)
    with driven_elevator(model, drive):
        assert any(tmp_path.iterdir())
    assert not any(tmp_path.iterdir())
    with pytest.raises(RuntimeError), driven_elevator(model, drive):
        raise RuntimeError
    assert not any(tmp_path.iterdir())


def test_halving_the_communication_step_changes_little(model, reference):
    finer = trip(model, step=0.01).iloc[::2].reset_index(drop=True)
    # The drive feels each tension one communication step late: some micrometres of a hoist rope's stretch.
    assert (finer["car_position"] - reference["car_position"]).abs().max() < 5e-5
    assert (finer["cw_low"] - reference["cw_low"]).abs().max() < 5e-5


def test_the_drive_hardly_feels_the_rope_but_does(model, reference):
    alone = trip(model, coupling="one-way")
    difference = (alone["car_position"] - reference["car_position"]).abs().max()
    assert 0.0 < difference < 1e-3


def test_an_fmu_is_used_only_if_it_is_our_own_or_named(tmp_path, monkeypatch):
    built = fmu_cache.drive_fmu()
    (tmp_path / "dist").mkdir()
    shutil.copy(built, tmp_path / "dist")
    monkeypatch.chdir(tmp_path)
    assert fmu_cache.drive_fmu() == built
    named = NamedFmus.read(["dist/ElevatorDrive.fmu"])
    assert named.drive() == Path("dist/ElevatorDrive.fmu")
    assert named.rope(4, ()) == fmu_cache.rope_fmu(4)


def test_files_that_are_no_fmus_of_ours_are_refused(tmp_path):
    (tmp_path / "text.fmu").write_text("no FMU at all")
    drive = fmu_cache.drive_fmu()
    for files, sentence in (
        ([tmp_path / "absent.fmu"], "absent.fmu: cannot be read: No such file"),
        ([tmp_path / "text.fmu"], "text.fmu: not an FMU: "),
        ([drive, drive], f"{drive}: {drive} is an FMU of ElevatorDrive too; one of each model is accepted"),
    ):
        with pytest.raises(InputError) as caught:
            NamedFmus.read(files)
        assert sentence in str(caught.value) and "\n" not in str(caught.value)


def test_a_named_fmu_gives_the_same_numbers(model, reference):
    named = NamedFmus.read([fmu_cache.drive_fmu(), fmu_cache.rope_fmu(len(model.sensors))])
    with driven_elevator(model, load_drive(None, TRIP), fmus=named) as elevator:
        assert simulate(elevator, [one.name for one in model.sensors], Timing(2.0, 0.02)).table.equals(reference)


def test_what_an_fmu_refuses_is_told_in_its_words():
    with FmuParticipant("motion", fmu_cache.drive_fmu(), {"profile.speed": 99.0}) as drive, pytest.raises(InputError) as caught:
        drive.enter_initialization(0.0)
        drive.exit_initialization()
    assert "profile.speed = 99 m/s: 0.01 to 25 m/s is accepted" in str(caught.value)
    fmu = fmu_cache.drive_fmu()
    with FmuParticipant("motion", fmu, {"profile.sped": 1.0}) as drive, pytest.raises(InputError, match="sped is"):
        drive.enter_initialization(0.0)


def test_a_failing_step_is_told_in_the_fmus_words():
    with FmuParticipant("motion", fmu_cache.drive_fmu(), {}) as drive:
        drive.enter_initialization(0.0)
        drive.exit_initialization()
        drive.step(0.0, 0.01)
        with pytest.raises(SimulationError, match=r"^motion: ElevatorDrive 'motion' at t = 0\.01 s: step from 5\.0 s: [^\n]*$"):
            drive.step(5.0, 0.01)


def test_the_rope_that_cannot_reach_is_refused(model):
    with (
        pytest.raises((InputError, SimulationError), match="rope"),
        driven_elevator(model, load_drive(None, TRIP), direct=True) as elevator,
    ):
        elevator.participants[1].enter_initialization(0.0)
        elevator.participants[1].set({"car_position": 0.0, "counterweight_position": 100.0})
        elevator.participants[1].exit_initialization()
