"""Runs FMUs in installed importers that are programs, and compares what they write last with fmpy.

    python benchmarks/importer_programs.py dist/*_native*.fmu dist/Elevator.ssp --fmusim PATH --fmucheck PATH --omsimulator PATH

fmusim is that of the Reference FMUs, fmuCheck the FMU Compliance Checker (FMI 2.0 only), OMSimulator that of OpenModelica; those
that are given run each FMU with its start values and, except by OMSimulator, the inputs of its reference result.
An SSP is run by OMSimulator alone, without a comparison.
"""

import argparse
import contextlib
import csv
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_csv

from comprope.fmi.reference_result import INPUT_FILE

Command = Callable[[float, float, str, list[str]], list[str]]  # stop and step [s], file of results, file of inputs if any
COMMANDS: dict[str, Command] = {
    "fmusim": lambda stop, step, out, inputs: [
        "--interface-type", "cs", "--stop-time", repr(stop), "--output-interval", repr(step), "--output-file", out,
        *(part for name in inputs for part in ("--input-file", name)),
    ],
    "fmucheck": lambda stop, step, out, inputs: [
        "-k", "cs", "-h", repr(step), "-n", "0", "-s", repr(stop), "-l", "3", "-o", out,
        *(part for name in inputs for part in ("-i", name)),
    ],
    "omsimulator": lambda stop, step, out, _: [
        "--mode=cs", "--suppressPath=true", f"--stepSize={step!r}", f"--stopTime={stop!r}", f"--resultFile={out}",
    ],
}  # fmt: skip
Values = dict[str, "np.ndarray[tuple[int], np.dtype[np.float64]]"]  # by name; those of an array together


def last_row(path: Path) -> Values:
    """The last values in a table, without the names of systems before those of variables."""
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = [row for row in csv.reader(file) if row]
    names = [name.strip().rpartition(".")[2] for name in head]
    return {name: np.array(text.split(), float) for name, text in zip(names, rows[-1], strict=False) if text}


def expected(fmu: str, stop: float, step: float, inputs: Path | None) -> tuple[Values, dict[str, float]]:
    """fmpy's last values of the continuous outputs, and their nominal values."""
    outputs = [
        one for one in read_model_description(fmu).modelVariables if one.causality == "output" and one.variability == "continuous"
    ]
    names = [one.name for one in outputs]
    given = None if inputs is None else read_csv(inputs)
    with contextlib.redirect_stdout(None):  # fmpy names each input that the table does not have
        result = simulate_fmu(fmu, stop_time=stop, step_size=step, output_interval=step, output=names, input=given)
    nominal = {one.name: float(one.nominal or 1.0) for one in outputs}
    return {name: np.atleast_1d(result[name][-1]) for name in names}, nominal


def inputs_of(fmu: str, folder: str) -> Path | None:
    """The inputs inside an FMU, unpacked."""
    with zipfile.ZipFile(fmu) as archive:
        return Path(archive.extract(INPUT_FILE, folder)) if INPUT_FILE in archive.namelist() else None


def outcome(kind: str, program: str, fmu: str, stop: float, step: float) -> str:
    """How a program got on with an FMU: the largest difference from fmpy, or why it failed."""
    with tempfile.TemporaryDirectory() as folder:
        out, inputs = Path(folder) / "result.csv", None if kind == "omsimulator" else inputs_of(fmu, folder)
        command = [program, *COMMANDS[kind](stop, step, str(out), [str(inputs)] if inputs else []), fmu]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        lines = (result.stdout + result.stderr).splitlines()
        said = [line for line in lines if "error" in line.lower() or "warning" in line.lower()]
        if result.returncode or not out.is_file():
            return f"FAILED: exit status {result.returncode}, {said[-1] if said else 'nothing said'}"
        found = last_row(out)
        reached = float(found.get("time", np.array([stop]))[0])
        remarks = f"; said: {said[0].strip()}" if said else ""
        if fmu.endswith(".ssp"):
            return f"ran to {reached:g} s{remarks}"
        values, nominal = expected(fmu, reached, step, inputs)
        differences = {name: float(abs(found[name] - value).max()) / nominal[name] for name, value in values.items()}
        worst = max(differences, key=differences.__getitem__)
        return f"{differences[worst]:.1e} of nominal ({worst}){remarks}"


def main() -> int:
    """Print the table; the exit status is 1 if a program failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE")
    for kind in COMMANDS:
        parser.add_argument(f"--{kind}", metavar="PATH")
    parser.add_argument("--stop", type=float, default=4.0, metavar="S")
    parser.add_argument("--step", type=float, default=0.01, metavar="S")
    options = parser.parse_args()
    failed = False
    print("| file | program | largest difference from fmpy at the end |\n|---|---|---|")
    for file in options.files:
        for kind in COMMANDS:
            program = getattr(options, kind)
            newer = kind == "fmucheck" and not file.endswith(".ssp") and read_model_description(file).fmiVersion == "3.0"
            if not program or newer or (file.endswith(".ssp") and kind != "omsimulator"):
                continue
            found = outcome(kind, program, file, options.stop, options.step)
            failed |= found.startswith("FAILED")
            print(f"| {Path(file).name} | {kind} | {found} |", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
