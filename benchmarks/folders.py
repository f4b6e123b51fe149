"""FMUs unpacked into folders with names of any kind, and a trip simulated while temporary files lie there.

    python benchmarks/folders.py dist/*.fmu

Each FMU is run by fmpy for three steps in each folder, and `comprope simulate` with FMUs of its own unpacked there for one
second of a trip; its result must be the same everywhere, and no file may be left.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

import comprope_system as cs

sys.path.insert(0, str(Path(__file__).parent.parent))
from tests.fmi3_pair import Slave
from tests.test_fmi_importers import FOLDERS

DURATION = 1.0  # s


def ran(path: str, folder: Path) -> str:
    """How three steps of an FMU unpacked into a folder went."""
    description = read_model_description(path)
    unpacked = extract(path, unzipdir=str(folder / Path(path).stem))
    name = description.coSimulation.modelIdentifier
    slave = (Slave if description.fmiVersion == "3.0" else FMU2Slave)(
        guid=description.guid, unzipDirectory=unpacked, modelIdentifier=name, instanceName=name
    )
    try:
        slave.instantiate()
        slave.setupExperiment(startTime=0.0)
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        for k in range(3):
            slave.doStep(0.01 * k, 0.01)
        slave.terminate()
        slave.freeInstance()
    except Exception as error:  # what goes wrong is the result
        return f"FAILED: {error}"
    return "runs"


def simulated(folder: Path) -> np.ndarray:
    """The first displacement of a trip whose FMUs are unpacked into a folder; raises if files are left there."""
    tempfile.tempdir = str(folder)
    result = cs.simulate("tower50", duration=DURATION, fmu=True)
    tempfile.tempdir = None
    if left := sorted(path.name for path in folder.iterdir()):
        raise RuntimeError(f"left in {folder}: {', '.join(left)}")
    return np.asarray(result.table["cw_low"])


def main() -> int:
    """Print the table; the exit status is 1 if anything failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmus", nargs="+", metavar="FMU")
    options, failed, expected = parser.parse_args(), False, None
    print("| folder | FMUs | simulate |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as root:
        for name in FOLDERS:
            folder, temporary = Path(root) / name, Path(root) / "simulate" / name
            temporary.mkdir(parents=True)
            outcomes = {path: ran(path, folder) for path in options.fmus}
            found = simulated(temporary)
            expected = found if expected is None else expected
            same = "runs" if np.array_equal(found, expected) else "FAILED: another result"
            failures = "; ".join(f"{Path(path).name} {text}" for path, text in outcomes.items() if text != "runs")
            failed |= bool(failures) or same != "runs"
            print(f"| `{name}` | {failures or 'run'} | {same} |", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
