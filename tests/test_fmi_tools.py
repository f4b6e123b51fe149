"""Both native FMUs in tools that others wrote, and under masters of every order."""

import gc
import json
import logging
import shutil
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException

from comprope.errors import InputError
from comprope.rope.model_file import load
from comprope_system import presets
from comprope_system.simulation.cosim.fmu_participant import FmuParticipant
from comprope_system.simulation.fmu_export.workflow import elevator_system

from .native_fmu import compiler, native_fmu

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from masters import ORDERS, SENSOR, in_fmus, trip

pytestmark = compiler
NAMES = ("ElevatorDrive", "CompensationRope")
DURATION, STEP = 4.0, 0.01  # s


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the FMUs, and the system of both."""
    for name in NAMES:
        shutil.copy(native_fmu("native", name), tmp_path)
    drive, rope = (tmp_path / f"{name}_native.fmu" for name in NAMES)
    elevator_system(load(presets.model_path("tower50")), rope, drive)
    return tmp_path


def made_by_master(order: str, propagates: str, step: float) -> tuple[float, float, float]:
    return trip(order, propagates, 0.0, DURATION, step, in_fmus(*(native_fmu("native", name) for name in NAMES)))


# -- fmu-manipulation-toolbox ----------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("ending", ["native", "native_fmi3"])
def test_fmutool_finds_them_compliant(name: str, ending: str, caplog: pytest.LogCaptureFixture) -> None:
    from fmu_manipulation_toolbox.checker import OperationGenericCheck
    from fmu_manipulation_toolbox.operations import FMU

    path = native_fmu(ending, name)
    check = OperationGenericCheck()
    with caplog.at_level(logging.WARNING), FMU(str(path)) as fmu:
        fmu.apply_operation(check)
    assert check.compliant_with_version == read_model_description(str(path)).fmiVersion
    assert [record.message for record in caplog.records] == []


def contained(folder: Path, description: str, sequential: bool) -> Any:
    """The trip in a container of both FMUs, which is an FMU itself."""
    from fmu_manipulation_toolbox.assembly import Assembly

    made = Assembly(description, fmu_directory=folder, default_step_size=STEP, default_sequential=sequential)
    made.make_fmu()
    return simulate_fmu(str(folder / "Elevator.fmu"), stop_time=DURATION, step_size=STEP, output_interval=STEP)


@pytest.mark.parametrize(("order", "sequential"), [("drive first", True), ("both at once", False)])
def test_fmucontainer_makes_the_trip_that_a_master_of_its_order_makes(folder: Path, order: str, sequential: bool) -> None:
    """It does not propagate the tensions at initialization."""
    drive, rope = (f"{name}_native.fmu" for name in NAMES)
    switches = {"derivative_inputs": True, "inputs_at_end": sequential}
    start = [[rope, name, value] for name, value in switches.items()]
    (folder / "elevator.json").write_text(json.dumps({"name": "Elevator.fmu", "fmu": [drive, rope], "start": start}))
    seen = contained(folder, "elevator.json", sequential)[SENSOR]
    high, low, _ = made_by_master(order, "positions", STEP)
    rest = seen[0]
    assert 1e3 * (seen.max() - rest) == pytest.approx(high, abs=1e-4)
    assert 1e3 * (seen.min() - rest) == pytest.approx(low, abs=1e-4)


def test_fmucontainer_reads_the_system(folder: Path) -> None:
    found = contained(folder, "Elevator.ssp", sequential=False)
    _, _, car = made_by_master("both at once", "nothing", STEP)
    assert found["elevatordrive_native.car_position"][-1] == pytest.approx(car, abs=1e-6)


# -- pyssp-standard --------------------------------------------------------------------------------


def test_pyssp_reads_the_system_and_writes_it_whole(folder: Path) -> None:
    """What it writes it reads again; version 0.9.1 puts the units where the standard's schema does not expect them."""
    from pyssp_standard.ssp import SSP

    path = folder / "Elevator.ssp"
    before = connections(path)
    with SSP(path, mode="a") as system:
        assert {Path(name).name for name in system.resources} == {f"{name}_native.fmu" for name in NAMES}
        with system.system_structure as structure:
            structure.name = "Tower"
    assert connections(path) == before and len(before) == 9
    with zipfile.ZipFile(path) as archive:
        written = archive.read("SystemStructure.ssd")
        assert {f"resources/{name}_native.fmu" for name in NAMES} <= set(archive.namelist())
    assert b'name="Tower"' in written and b"derivative_inputs" in written and b"FixedStepMaster" in written


def connections(path: Path) -> list[Any]:
    """The connections as pyssp-standard reads them."""
    from pyssp_standard.ssp import SSP

    with SSP(path, mode="r") as system, system.system_structure as structure:
        return [one.as_dict() for one in structure.connections()]


# -- masters ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", ORDERS)
def test_masters_of_every_order_make_the_same_trip(order: str) -> None:
    """To a hundredth of a millimetre in steps of 1 to 25 ms, whatever they propagate at initialization."""
    high, low, car = made_by_master("drive first", "all", 0.005)
    for propagates in ("all", "nothing"):
        for step in (0.001, 0.025):
            found = made_by_master(order, propagates, step)
            assert found == pytest.approx((high, low, car), abs=0.01)
            assert found[2] == pytest.approx(car, abs=1e-5)  # m
    assert made_by_master(order, "positions", 0.025) == pytest.approx(made_by_master(order, "all", 0.025), abs=1e-4)


# -- our own co-simulation beside other users of fmpy -----------------------------------------------


def test_each_participant_hears_its_own_fmu() -> None:
    drive, rope = (FmuParticipant(name, native_fmu("native", name), {}) for name in NAMES)
    with drive, rope:
        for one in (drive, rope):
            one.enter_initialization(0.0)
        drive.set({"servo.torque_limit": 100.0})
        with pytest.raises(InputError, match=r"ElevatorDrive: .*servo\.torque_limit = 100 N\.m: more than the 441\.45 N\.m"):
            drive.exit_initialization()
        rope.set({"sheave.mass": -1.0})
        with pytest.raises(InputError, match=r"sheave\.mass = -1 kg: 0\.1 to 20000 kg is accepted"):
            rope.exit_initialization()


def test_fmpy_logs_on_after_our_co_simulation(capfd: pytest.CaptureFixture[str]) -> None:
    """fmpy has one logger for all instances, which must outlive ours."""
    path = native_fmu("native", "ElevatorDrive")
    with FmuParticipant("gone", path, {}):
        pass
    gc.collect()
    with pytest.raises(FMICallException):
        simulate_fmu(str(path), start_values={"servo.torque_limit": 100.0}, stop_time=0.1)
    assert "more than the 441.45 N.m that hold the car initially is accepted" in capfd.readouterr().out
