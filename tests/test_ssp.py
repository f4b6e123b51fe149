"""Drive and rope as one system file."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy.ssp import simulation
from fmpy.ssp.ssd import read_ssd

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
    forward = {("drive", name, "rope", name) for name in motions}
    assert connections == forward | {("rope", f"{end}_end_tension", "drive", f"{end}_end_tension") for end in ends}


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


def with_start_values(instantiate: Any) -> Any:
    """What fmpy does to instantiate a component, and then its connectors get the values that its FMU starts with."""

    def call(component: Any, *arguments: Any) -> None:
        instantiate(component, *arguments)
        for connector in component.connectors:
            connector.value = simulation.get_value(component, connector.name)

    return call
