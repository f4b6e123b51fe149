"""Drive and rope as one system file."""

import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy.ssp import simulation
from fmpy.ssp.ssd import read_ssd

from comprope.rope.model_file import load
from comprope_system import presets
from comprope_system.simulation.fmu_export.workflow import elevator_system

from .native_fmu import compiler, native_fmu

BUILDER = Path(__file__).parent.parent / "build_fmu.py"


@pytest.fixture(scope="module")
def system(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("dist")
    command = [sys.executable, str(BUILDER), "--ssp", "--out", str(out)]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert result.stdout.splitlines()[-1] == str(out / "Elevator.ssp")
    return out / "Elevator.ssp"


def test_valid_and_connected_by_name(system: Path) -> None:
    found = read_ssd(str(system)).system  # checks the description against the standard's schema
    assert [one.name for one in found.elements] == ["drive", "rope"]
    connections = {(one.startElement, one.startConnector, one.endElement, one.endConnector) for one in found.connections}
    ends = ("car", "counterweight")
    motions = {f"{end}_{rate}" for end in ends for rate in ("position", "velocity", "acceleration")}
    forward = {("drive", name, "rope", name) for name in motions} | {(None, "destination", "drive", "destination")}
    assert connections == forward | {("rope", f"{end}_end_tension", "drive", f"{end}_end_tension") for end in ends}


def test_units_experiment_and_master_are_given(system: Path) -> None:
    """Every unit of a connector is defined, and OMSimulator finds its master where it looks for it."""
    with zipfile.ZipFile(system) as archive:
        root = ET.fromstring(archive.read("SystemStructure.ssd"))
    spaces = {
        "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
        "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
        "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
    }
    used = {one.get("unit") for one in root.iterfind(".//ssd:Connector/ssc:Real", spaces)} - {None}
    defined = {one.get("name"): one[0].attrib for one in root.iterfind("ssd:Units/ssc:Unit", spaces)}
    assert used <= set(defined) and defined["N.m"] == {"kg": "1", "m": "2", "s": "-2"}
    experiment = root.find("ssd:DefaultExperiment", spaces)
    assert experiment is not None and float(experiment.get("stopTime", "0")) >= 30.0
    annotation = root.find("ssd:System/ssd:Annotations/ssc:Annotation[@type='org.openmodelica']", spaces)
    assert annotation is not None
    master = annotation.find("oms:Annotations/oms:SimulationInformation/oms:FixedStepMaster", spaces)
    assert master is not None and master.get("description") == "oms-ma" and master.get("stepSize") == "0.01"
    connector = root.find("ssd:System/ssd:Connectors/ssd:Connector", spaces)
    assert connector is not None and connector.attrib == {"name": "destination", "kind": "input"}


def test_runs_in_fmpy(system: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """fmpy gives zero to every connected input at first, which would throw the rope's ends by the height of the shaft."""
    monkeypatch.setattr(simulation, "instantiate_fmu", with_start_values(simulation.instantiate_fmu))
    result = simulation.simulate_ssp(str(system), stop_time=4.0, step_size=0.01)
    assert all(np.all(np.isfinite(result[name])) for name in result.dtype.names)
    assert result["drive.car_position"][-1] > 1.0
    # The rope lags one step behind the drive.
    assert np.array_equal(result["rope.car_position"], result["drive.car_position"])
    # Whatever rings because each component gets the inputs from the other a step late: the force stays near the sheave's weight.
    assert result["rope.sheave_force"] == pytest.approx(1177.2, rel=0.15)


def test_an_example_has_a_building_in_the_system(system: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A building of two modes under a record sways, and moves the rope's ends."""
    times = np.arange(0.0, 10.0, 0.02)
    record = "".join(f"{t:.2f},{0.5 * np.sin(5.0 * t):.9g}\n" for t in times)
    (tmp_path / "ground.csv").write_text(f"time,ground_acceleration\n{record}", encoding="utf-8")
    fmus, out = [system.with_name(f"{name}.fmu") for name in ("ElevatorDrive", "CompensationRope")], tmp_path / "system.ssp"
    command = [sys.executable, BUILDER.parent / "docs" / "examples" / "building_ssp.py", *fmus, tmp_path / "ground.csv", out]
    subprocess.run(command, check=True, timeout=120)
    found = read_ssd(str(out)).system
    inputs = {one.endConnector for one in found.connections if one.startElement == "building" and one.endElement == "rope"}
    assert inputs == {"car_lateral_displacement", "counterweight_lateral_displacement", "base_acceleration"}
    monkeypatch.setattr(simulation, "instantiate_fmu", with_start_values(simulation.instantiate_fmu))
    result = simulation.simulate_ssp(str(out), stop_time=3.0, step_size=0.01)
    assert np.ptp(result["rope.counterweight_lateral_displacement"]) > 1e-3
    assert np.ptp(result["rope.base_acceleration"]) > 0.9
    assert all(np.all(np.isfinite(result[name])) for name in result.dtype.names)


@compiler
def test_native_drive_and_rope_make_a_system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same trip as with the FMUs of one process, with no Python in it."""
    parts = [Path(shutil.copy(native_fmu("native", name), tmp_path)) for name in ("CompensationRope", "ElevatorDrive")]
    system = elevator_system(load(presets.model_path("tower50")), *parts)
    with zipfile.ZipFile(system) as archive:
        assert {f"resources/{part.name}" for part in parts} <= set(archive.namelist())
    monkeypatch.setattr(simulation, "instantiate_fmu", with_start_values(simulation.instantiate_fmu))
    result = simulation.simulate_ssp(str(system), stop_time=3.0, step_size=0.01)
    assert result["drive.car_position"][-1] > 0.5
    assert result["rope.sheave_force"] == pytest.approx(1177.2, rel=0.15)


def with_start_values(instantiate: Any) -> Any:
    """What fmpy does to instantiate a component, and then its connectors get the values that its FMU starts with."""

    def call(component: Any, *arguments: Any) -> None:
        instantiate(component, *arguments)
        for connector in component.connectors:
            connector.value = simulation.get_value(component, connector.name)

    return call
