"""Simulates FMUs in independent importers and compares their final outputs.

    python benchmarks/importers.py dist/*.fmu [--steps 1000] [--step-size 0.001]

Each importer (fmpy, libcosimpy, ecospy; those installed; ecospy needs libtbb12) validates and runs each FMU in a process
of its own, and then all FMUs together, unconnected; libcosim does not know FMI 3.0. So that a rope has something to do,
the building sways and its sheave is light. The table gives the processor time for all steps and the largest difference of
a Real output from fmpy's, relative to its nominal value. Whatever an FMU or importer writes to standard error counts as a
failure, since ecospy passes over errors that FMUs report.
"""

import argparse
import importlib.util
import json
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from fmpy import extract, read_model_description
from fmpy.model_description import ModelVariable
from fmpy.validation import validate_fmu

sys.path.insert(0, str(Path(__file__).parent.parent))

Ends = dict[str, list[float]]  # Real outputs at the end, by "FMU.output"; the values of an array together
SWAYING = {"effects.building_sway.amplitude": 0.1, "effects.building_sway.frequency": 0.5, "sheave.mass": 60.0}


def set_parameters(path: str) -> dict[str, tuple[int, float]]:
    """The parameters set in an FMU: value reference and value by name."""
    places = {one.name: one.valueReference for one in read_model_description(path).modelVariables}
    return {name: (places[name], value) for name, value in SWAYING.items() if name in places}


def in_fmpy(paths: list[str], steps: int, dt: float) -> tuple[float, Ends]:
    """Step the FMUs through fmpy, one after the other in each step."""
    from fmpy.fmi2 import FMU2Slave
    from tests.fmi3_pair import Slave

    slaves = {}
    for path in paths:
        if problems := validate_fmu(path):
            raise ValueError("; ".join(problems))
        description, folder = read_model_description(path), extract(path)
        name = description.coSimulation.modelIdentifier
        kind = Slave if description.fmiVersion == "3.0" else FMU2Slave
        slave = kind(guid=description.guid, unzipDirectory=folder, modelIdentifier=name, instanceName=name)
        slave.instantiate()
        slave.setupExperiment(startTime=0.0)
        for place, value in set_parameters(path).values():
            slave.setReal([place], [value])
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        slaves[path] = slave
    begin = time.process_time()
    for count in range(steps):
        for slave in slaves.values():
            slave.doStep(count * dt, dt)
    seconds = time.process_time() - begin

    def read(path: str, one: ModelVariable) -> list[float]:
        slave = slaves[path]
        if not isinstance(slave, Slave):
            return slave.getReal([one.valueReference])
        return slave.getFloat64([one.valueReference], one.shape[0] if one.dimensions else 1)

    return seconds, _ends(paths, read)


def in_libcosimpy(paths: list[str], steps: int, dt: float) -> tuple[float, Ends]:
    """Step the FMUs through libcosim's fixed-step algorithm."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_step_size(round(dt * 1e9))
    slaves = [CosimLocalSlave(fmu_path=path, instance_name=Path(path).stem) for path in paths]
    indices = {path: execution.add_local_slave(slave) for path, slave in zip(paths, slaves, strict=True)}
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    for path, index in indices.items():
        for place, value in set_parameters(path).values():
            execution.real_initial_value(index, place, value)
    execution.step()  # the first step initializes as well
    begin = time.process_time()
    if not execution.step(step_count=steps - 1):
        raise RuntimeError(str(execution.status()))
    seconds = time.process_time() - begin
    return seconds, _ends(paths, lambda path, one: observer.last_real_values(indices[path], [one.valueReference]))


def in_ecospy(paths: list[str], steps: int, dt: float) -> tuple[float, Ends]:
    """Step the FMUs through Ecos."""
    from ecospy import EcosSimulation, EcosSimulationStructure

    with EcosSimulationStructure() as structure:
        for path in paths:
            structure.add_model(Path(path).stem, path)
        values = {f"{Path(path).stem}::{name}": value for path in paths for name, (_, value) in set_parameters(path).items()}
        structure.add_parameter_set("swaying", values)
        with EcosSimulation(structure=structure, step_size=dt) as simulation:
            simulation.init(parameter_set="swaying")
            begin = time.process_time()
            simulation.step(steps)
            seconds = time.process_time() - begin

            def read(path: str, one: ModelVariable) -> list[float]:
                # Of an array Ecos asks for one value, and takes no notice of the error.
                return [] if one.dimensions else [simulation.get_real(f"{Path(path).stem}::{one.name}")]

            return seconds, _ends(paths, read)


IMPORTERS: dict[str, Callable[[list[str], int, float], tuple[float, Ends]]] = {
    "fmpy": in_fmpy,
    "libcosimpy": in_libcosimpy,
    "ecospy": in_ecospy,
}


def compare(paths: list[str], steps: int, dt: float) -> int:
    """Print a line for each importer and set of FMUs; returns how many failed."""
    failures = 0
    print(f"{'FMUs':40} {'importer':12} {'CPU s':>9} {'us/step':>9}  largest difference from fmpy")
    for chosen in [*([path] for path in paths), *([paths] if len(paths) > 1 else [])]:
        reference: Ends = {}
        for importer in filter(importlib.util.find_spec, _importers_of(chosen)):
            label = f"{'+'.join(Path(path).stem for path in chosen):40} {importer:12}"
            found = _apart(importer, chosen, steps, dt)
            if isinstance(found, str):
                failures += 1
                print(f"{label} FAILED: {found}")
                continue
            seconds, ends = found
            reference = reference or ends
            print(f"{label} {seconds:9.3f} {1e6 * seconds / steps:9.1f}  {_difference(chosen, reference, ends)}")
    return failures


def _importers_of(paths: list[str]) -> list[str]:
    """The importers that support the FMUs' versions of FMI: libcosim supports 2.0 at most."""
    newer = any(read_model_description(path).fmiVersion == "3.0" for path in paths)
    return [name for name in IMPORTERS if not (newer and name == "libcosimpy")]


def _apart(importer: str, paths: list[str], steps: int, dt: float) -> tuple[float, Ends] | str:
    """The final outputs of an importer, run in its own process, or why it failed."""
    command = [sys.executable, __file__, "--worker", importer, "--steps", str(steps), "--step-size", repr(dt), *paths]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode or result.stderr.strip():
        return f"exit status {result.returncode}: {(result.stderr.strip().splitlines() or ['no message'])[-1]}"
    seconds, ends = json.loads(result.stdout.splitlines()[-1])
    return seconds, ends


def _ends(paths: list[str], read: Callable[[str, ModelVariable], list[float]]) -> Ends:
    return {
        f"{Path(path).stem}.{one.name}": read(path, one)
        for path in paths
        for one in read_model_description(path).modelVariables
        if one.causality == "output" and one.type in ("Real", "Float64")
    }


def _difference(paths: list[str], reference: Ends, ends: Ends) -> str:
    nominals = {
        f"{Path(path).stem}.{one.name}": float(one.nominal or 1.0)
        for path in paths
        for one in read_model_description(path).modelVariables
    }
    differences = {
        name: max(abs(one - other) for one, other in zip(values, reference[name], strict=True)) / nominals[name]
        for name, values in ends.items()
        if values
    }
    worst = max(differences, key=differences.__getitem__)
    left_out = "" if all(ends.values()) else "; arrays were not read"
    return f"{differences[worst]:.1e} of nominal ({worst}){left_out}"


def main() -> int:
    """Compare; or, as a worker process, run one importer and print its final outputs as JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmus", nargs="+", metavar="FMU")
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--step-size", type=float, default=0.001, metavar="SECONDS")
    parser.add_argument("--worker", choices=IMPORTERS, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.worker:
        print(json.dumps(IMPORTERS[options.worker](options.fmus, options.steps, options.step_size)))
        return 0
    return 1 if compare(options.fmus, options.steps, options.step_size) else 0


if __name__ == "__main__":
    sys.exit(main())
