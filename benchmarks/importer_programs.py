"""Runs FMUs in installed importers that are programs, and compares what they write last with fmpy.

    python benchmarks/importer_programs.py dist/*_native.fmu dist/Elevator.ssp --fmusim PATH --fmucheck PATH --omsimulator PATH

fmusim is that of the Reference FMUs, fmuCheck the FMU Compliance Checker (FMI 2.0 only), OMSimulator that of OpenModelica; those
that are given are run, with the start values of each FMU. An SSP is run by OMSimulator alone, without a comparison.
"""

import argparse
import csv
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from fmpy import read_model_description, simulate_fmu

Command = Callable[[str, str, float, float, str], list[str]]  # program, FMU, stop and step [s], file of results
COMMANDS: dict[str, Command] = {
    "fmusim": lambda program, fmu, stop, step, out: [
        program, "--interface-type", "cs", "--stop-time", repr(stop), "--output-interval", repr(step), "--output-file", out, fmu,
    ],
    "fmucheck": lambda program, fmu, stop, step, out: [
        program, "-k", "cs", "-h", repr(step), "-n", "0", "-s", repr(stop), "-l", "3", "-o", out, fmu,
    ],
    "omsimulator": lambda program, fmu, stop, step, out: [
        program, "--mode=cs", "--suppressPath=true", f"--stepSize={step!r}", f"--stopTime={stop!r}", f"--resultFile={out}", fmu,
    ],
}  # fmt: skip


def last_row(path: Path) -> dict[str, float]:
    """The last values in a table by name, without the names of systems before them."""
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = [row for row in csv.reader(file) if row]
    return {name.strip().rpartition(".")[2]: float(value) for name, value in zip(head, rows[-1], strict=False) if value}


def expected(fmu: str, stop: float, step: float) -> tuple[dict[str, float], dict[str, float]]:
    """fmpy's last values of the continuous outputs, and their nominal values, by name."""
    outputs = [
        one for one in read_model_description(fmu).modelVariables if one.causality == "output" and one.variability == "continuous"
    ]
    names = [one.name for one in outputs]
    result = simulate_fmu(fmu, stop_time=stop, step_size=step, output_interval=step, output=names)
    nominal = {one.name: float(one.nominal or 1.0) for one in outputs}
    return {name: float(result[name][-1]) for name in names}, nominal


def outcome(kind: str, program: str, fmu: str, stop: float, step: float) -> str:
    """How a program got on with an FMU: the largest difference from fmpy, or why it failed."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "result.csv"
        result = subprocess.run(COMMANDS[kind](program, fmu, stop, step, str(out)), capture_output=True, text=True, check=False)
        lines = (result.stdout + result.stderr).splitlines()
        said = [line for line in lines if "error" in line.lower() or "warning" in line.lower()]
        if result.returncode or not out.is_file():
            return f"FAILED: exit status {result.returncode}, {said[-1] if said else 'nothing said'}"
        found = last_row(out)
        remarks = f"; said: {said[0].strip()}" if said else ""
        if fmu.endswith(".ssp"):
            return f"ran to {found.get('time', stop):g} s{remarks}"
        values, nominal = expected(fmu, found.get("time", stop), step)
        differences = {name: abs(found[name] - value) / nominal[name] for name, value in values.items()}
        worst = max(differences, key=differences.__getitem__)
        return f"{differences[worst]:.1e} of nominal ({worst}){remarks}"


def main() -> int:
    """Print the table; the exit status is 1 if a program failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE")
    for kind in COMMANDS:
        parser.add_argument(f"--{kind}", metavar="PATH")
    parser.add_argument("--stop", type=float, default=5.0, metavar="S")
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
