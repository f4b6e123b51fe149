"""Drive, building and rope in one SSP file: `python docs/examples/building_ssp.py DRIVE.fmu ROPE.fmu ground.csv system.ssp`.

Builds the building's FMU from building_fmu.py and the record `ground.csv`, and connects every input with the output of its name.
The FMUs of drive and rope are those of `comprope fmu tower50`.
"""

import runpy
import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from comprope.drive.cosimulation import interface as drive_interface
from comprope.fmi.model_interface import ModelInterface, Variable
from comprope.fmi.ssp import Component, connections_by_name, write_ssp
from comprope.rope.model_file import load
from comprope.rope.simulator.cosimulation import interface as rope_interface
from comprope_system.presets import model_path

HERE = Path(__file__).resolve().parent
UNITS = {"base_acceleration": "m/s2"}  # of what is no length


def building_interface() -> ModelInterface:
    """Inputs and outputs of building_fmu.py, as the SSP file names them; it is not simulated from here."""
    described = runpy.run_path(str(HERE / "building_fmu.py"))
    inputs = [Variable(name, "real", "input", name, "m", start) for name, start in described["INPUTS"].items()]
    outputs = [Variable(name, "real", "output", name, UNITS.get(name, "m")) for name in described["OUTPUTS"]]
    return ModelInterface("BuildingSway", "building", (*inputs, *outputs), lambda *_: None)  # type: ignore[arg-type, return-value]


def main(drive: str, rope: str, record: str, out: str) -> None:
    """Write the system."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        parts = [Path(shutil.copy(one, folder)) for one in (drive, rope)]
        building = runpy.run_path(str(HERE / "building_trip.py"))["build"](record, folder)
        components = [
            Component("drive", parts[0], drive_interface(), exposed=("destination",)),
            Component("building", building, building_interface()),
            Component("rope", parts[1], rope_interface(load(model_path("tower50"))), {"derivative_inputs": True}),
        ]
        write_ssp(Path(out), "ElevatorInBuilding", components, connections_by_name(components))


if __name__ == "__main__":
    main(*sys.argv[1:])
