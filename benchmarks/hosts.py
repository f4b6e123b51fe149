"""A native FMU in a host without Python: under sanitizers and valgrind, for ARM in qemu, for Windows in wine.

    python benchmarks/hosts.py dist/CompensationRope_native.fmu [dist/CompensationRope_native_fmi3.fmu]
    python benchmarks/hosts.py dist/ElevatorDrive_native.fmu [dist/ElevatorDrive_native_fmi3.fmu]

The host is for FMI 2.0. The C sources compiled under sanitizers also take random calls from Python, for each FMU given.
Needs gcc (its address and undefined-behaviour sanitizers); valgrind if it is there; ziglang and, for ARM, qemu-aarch64
with a C library in QEMU_LIBRARIES, for Windows wine64.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

from fmpy import read_model_description

from comprope.native import linker
from comprope.native.c_source import kernels_header, model_source
from comprope.native.drive_component import drive_component
from comprope.native.llvm_ir import kernels
from comprope.native.rope_component import rope_component
from comprope.native.targets import TARGETS, machine_code

sys.path.insert(0, str(Path(__file__).parent.parent))
from tests.native_fmu import HOSTED, drive, tower

HOST = Path(__file__).parent.parent / "tests" / "native_host.c"
SCENARIOS = {"cycle": 50, "threads": 5, "states": 1, "wrong": 1, "memory": 1}
RIDE = 400  # steps of 10 ms
WINE = ("wine64", "/usr/lib/wine/wine64")
QEMU, QEMU_LIBRARIES = "qemu-aarch64", "/usr/aarch64-linux-gnu"  # Debian's qemu-user and libc6-arm64-cross
SANITIZED = "sanitized"  # GUID and instantiation token
CALLS = 5_000
_SANITIZED = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g", "-O1", "-std=c11")


def arguments(fmu: str, guid: str, binary: str, number: int) -> list[str]:
    """The arguments of the host program for an FMU."""
    description = read_model_description(fmu)
    places = {one.name: str(one.valueReference) for one in description.modelVariables}
    return [binary, guid, *(places[name] for name in HOSTED[description.modelName]), str(number)]


def run(command: list[str], line: int = -1) -> str:
    """A line of a program's output, the last one by default, or how it ended."""
    result = subprocess.run(
        command, capture_output=True, text=True, timeout=3600, check=False, env=os.environ | {"WINEDEBUG": "-all"}
    )
    lines = (result.stdout.strip() or result.stderr.strip() or "no output").splitlines()
    return lines[line] if result.returncode == 0 else f"exit status {result.returncode}: {lines[0]}"


def sanitized(fmu: str, stage: Path) -> Iterator[tuple[str, str]]:
    """Every scenario with the C sources compiled under sanitizers; the kernels are as in the FMU."""
    component = drive_component(drive()) if read_model_description(fmu).modelName == "ElevatorDrive" else rope_component(tower())
    generated = {
        "kernels.h": kernels_header(component),
        "model_variables.c": model_source(component.interface, SANITIZED, SANITIZED),
    }
    written = linker.c_sources(component.name) | {name: text.encode() for name, text in generated.items()}
    for name, content in written.items():
        (stage / name).write_bytes(content)
    (stage / "kernels.o").write_bytes(machine_code(kernels(component.name, {}), TARGETS["linux"]))
    sources = sorted(str(path) for path in stage.glob("*.c"))
    options = ["gcc", *_SANITIZED, f"-I{stage}", f"-I{linker.HEADERS}"]
    binary, host = str(stage / "sanitized.so"), str(stage / "host")
    shared = ["-shared", "-fPIC", "-fvisibility=hidden"]
    subprocess.run([*options, *shared, *sources, str(stage / "kernels.o"), "-o", binary, "-lm"], check=True)
    subprocess.run([*options, str(HOST), "-o", host, "-ldl", "-lpthread", "-lm"], check=True)
    for scenario, number in SCENARIOS.items():
        yield scenario, run([host, scenario, *arguments(fmu, SANITIZED, binary, number)])


def shaken(fmus: list[str], stage: Path) -> Iterator[tuple[str, str]]:
    """Random calls from Python on the binary compiled by `sanitized`, in place of each FMU's own."""
    for fmu in fmus:
        copy = stage / Path(fmu).name
        with zipfile.ZipFile(fmu) as archive, zipfile.ZipFile(copy, "w") as sanitized_fmu:
            for name in archive.namelist():
                sanitized_fmu.writestr(name, _sanitized_part(name, archive.read(name), read_model_description(fmu).guid, stage))
        # Of C++ as well: libraries that Python loads throw its exceptions.
        library = ":".join(run(["gcc", f"-print-file-name={name}"]) for name in ("libasan.so", "libstdc++.so"))
        command = [
            sys.executable,
            str(Path(__file__).with_name("robustness.py")),
            str(copy),
            "--calls",
            str(CALLS),
            "--corners",
            "0",
        ]
        # Python itself keeps memory to its end.
        yield copy.stem, run(["env", f"LD_PRELOAD={library}", "ASAN_OPTIONS=detect_leaks=0", *command])


def _sanitized_part(name: str, content: bytes, identity: str, stage: Path) -> bytes:
    if name == "modelDescription.xml":
        return content.replace(identity.encode(), SANITIZED.encode())
    return (stage / "sanitized.so").read_bytes() if name.endswith(".so") else content


def in_valgrind(fmu: str, stage: Path) -> Iterator[tuple[str, str]]:
    """Scenarios with the Linux binary of the FMU, kernels and all: memory not its own, not set, or not given back."""
    guid, binary, host = read_model_description(fmu).guid, unpacked(fmu, stage, "linux"), str(stage / "plain")
    subprocess.run(["gcc", "-std=c11", "-O1", f"-I{linker.HEADERS}", str(HOST), "-o", host, "-ldl", "-lpthread"], check=True)
    valgrind = ["valgrind", "-q", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite"]
    for scenario, number in {"cycle": 2, "states": 1, "wrong": 1, "memory": 1}.items():
        yield scenario, run([*valgrind, host, scenario, *arguments(fmu, guid, binary, number)])


def unpacked(fmu: str, stage: Path, target: str) -> str:
    """Path of the FMU's binary for a target."""
    place = TARGETS[target]
    with zipfile.ZipFile(fmu) as archive:
        return archive.extract(f"binaries/{place.folder}/{Path(fmu).name.partition('_')[0]}.{place.extension}", stage)


def in_qemu(fmu: str, stage: Path) -> Iterator[tuple[str, str]]:
    """Every scenario but threads with the binary of the FMU for ARM, and a ride beside that of the x86-64 binary."""
    binary, host, guid = unpacked(fmu, stage, "linux-arm64"), str(stage / "arm"), read_model_description(fmu).guid
    zig = [sys.executable, "-m", "ziglang", "cc", "-target", TARGETS["linux-arm64"].zig]
    libraries = ["-ldl", "-lpthread", "-lm"]
    subprocess.run([*zig, "-std=c11", "-O1", f"-I{linker.HEADERS}", str(HOST), "-o", host, *libraries], check=True)
    emulated = [QEMU, "-L", QEMU_LIBRARIES, host]
    for scenario in ("cycle", "states", "wrong", "memory"):
        yield scenario, run([*emulated, scenario, *arguments(fmu, guid, binary, SCENARIOS[scenario])])
    there = run([*emulated, "ride", *arguments(fmu, guid, binary, RIDE)], line=0)
    here = run([str(stage / "host"), "ride", *arguments(fmu, guid, unpacked(fmu, stage, "linux"), RIDE)], line=0)
    yield "ride of 4 s", f"{there}, on x86-64 {here}"


def in_wine(fmu: str, stage: Path, wine: str) -> Iterator[tuple[str, str]]:
    """Every scenario but threads with the Windows binary of the FMU, and a ride beside that of the Linux binary."""
    binary = unpacked(fmu, stage, "windows")
    host = str(stage / "host.exe")
    zig = [sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu"]
    subprocess.run([*zig, "-std=c11", "-O1", f"-I{linker.HEADERS}", str(HOST), "-o", host], check=True)
    guid, windows_path = read_model_description(fmu).guid, "Z:" + binary.replace("/", "\\")
    for scenario in ("cycle", "states", "wrong", "memory"):
        yield scenario, run([wine, host, scenario, *arguments(fmu, guid, windows_path, SCENARIOS[scenario])])
    there = run([wine, host, "ride", *arguments(fmu, guid, windows_path, RIDE)], line=0)
    here = run([str(stage / "host"), "ride", *arguments(fmu, guid, unpacked(fmu, stage, "linux"), RIDE)], line=0)
    yield "ride of 4 s", f"{there}, on Linux {here}"


def main() -> None:
    """Print the table."""
    fmu, *_ = fmus = sys.argv[1:]
    wine = next((found for name in WINE if (found := shutil.which(name))), None)
    with tempfile.TemporaryDirectory() as folder:
        print("| host | scenario | outcome |\n|---|---|---|")
        for scenario, outcome in sanitized(fmu, Path(folder)):
            print(f"| Linux, sanitized | {scenario} | {outcome} |", flush=True)
        for name, outcome in shaken(fmus, Path(folder)):
            print(f"| Linux, sanitized | random calls on {name} | {outcome} |", flush=True)
        if shutil.which("valgrind"):
            for scenario, outcome in in_valgrind(fmu, Path(folder)):
                print(f"| Linux, valgrind | {scenario} | {outcome} |", flush=True)
        zig = importlib.util.find_spec("ziglang")
        if zig and shutil.which(QEMU) and Path(QEMU_LIBRARIES).is_dir():
            for scenario, outcome in in_qemu(fmu, Path(folder)):
                print(f"| Linux arm64 binary in qemu | {scenario} | {outcome} |", flush=True)
        if wine and zig:
            for scenario, outcome in in_wine(fmu, Path(folder), wine):
                print(f"| Windows binary in wine | {scenario} | {outcome} |", flush=True)


if __name__ == "__main__":
    main()
