"""Compiles the C sources and links them with the kernels, for each system that there is a compiler for."""

import importlib.util
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from importlib import metadata
from pathlib import Path

import fmpy

from ..errors import InputError
from .targets import TARGETS, Target

C_SOURCES = Path(__file__).with_name("c")
HEADERS = Path(fmpy.__file__).parent / "c-code"  # those of the FMI standard, under its BSD licence
# Sums keep their order, as in the kernels; names that are not exported do not collide with those of other FMUs.
_OPTIONS = ("-std=c11", "-O2", "-ffp-contract=off", "-fvisibility=hidden", "-fno-sanitize=all", "-shared")


def c_sources(component: str) -> dict[str, bytes]:
    """The C files by name, with that of rope or drive."""
    found = [path for pattern in ("*.c", "*.h") for path in sorted(C_SOURCES.glob(pattern))]
    return {path.name: path.read_bytes() for path in (*found, C_SOURCES / "components" / f"{component}.c")}


def toolchain() -> str:
    """The compiler: zig and its version, or the system's own."""
    if _zig():
        return f"zig {metadata.version('ziglang')}, for {system_names(TARGETS)}"
    return f"{_system_compiler()}, for this system only; `pip install ziglang` brings a compiler for {system_names(TARGETS)}"


def linkable_targets() -> list[str]:
    """The targets that can be linked for, by their names in TARGETS: all with zig, otherwise this system."""
    return list(TARGETS) if _zig() else [host_target()]


def system_names(targets: Iterable[str]) -> str:
    """The names of the systems of some targets, as in `Linux and Windows`."""
    *most, last = dict.fromkeys(TARGETS[name].system for name in targets)
    return f"{', '.join(most)} and {last}" if most else last


def link_binaries(name: str, kernels: Mapping[str, bytes], sources: Mapping[str, bytes]) -> dict[str, bytes]:
    """Binaries of the FMU `name` by target, from the kernels' machine code by target and C files."""
    return {place: link(name, {**sources, "kernels.o": code}, TARGETS[place], ["-lm"]) for place, code in kernels.items()}


def link(name: str, files: Mapping[str, bytes], target: Target, libraries: Sequence[str]) -> bytes:
    """The binary `name` for a target, from C sources and object files."""
    with tempfile.TemporaryDirectory() as folder:
        stage = Path(folder)
        for path, content in files.items():
            (stage / path).write_bytes(content)
        output = f"{name}.{target.extension}"
        sources = sorted(path for path in files if path.endswith((".c", ".o")))
        options = [*_OPTIONS, *_extras(target, output), "-I.", f"-I{HEADERS}"]
        command = [*_compiler(target), *options, *sources, "-o", output, *libraries]
        result = subprocess.run(command, cwd=stage, capture_output=True, text=True, check=False)
        if result.returncode:
            raise InputError(f"{output} cannot be linked for {target.folder}: {_last_error(result.stderr)}")
        return (stage / output).read_bytes()


def _last_error(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if "error" in line.lower()] or text.strip().splitlines() or ["no message"]
    return lines[0]


def _extras(target: Target, output: str) -> Iterator[str]:
    yield "-s"
    if target.extension != "dll":
        yield "-fPIC"
    if target.extension == "dylib":
        yield f"-Wl,-install_name,@rpath/{output}"
    if target.extension == "so":
        yield from (f"-Wl,-soname,{output}", "-Wl,-z,defs")  # the latter refuses undefined symbols, as other systems do


def _compiler(target: Target) -> list[str]:
    return [sys.executable, "-m", "ziglang", "cc", "-target", target.zig] if _zig() else [_system_compiler()]


@cache
def _zig() -> bool:
    return importlib.util.find_spec("ziglang") is not None


def _system_compiler() -> str:
    found = next((name for name in ("cc", "gcc", "clang") if shutil.which(name)), None)
    if found is None:
        raise InputError("no C compiler: `pip install ziglang` brings one that compiles for every system")
    return found


def host_target() -> str:
    """The name in TARGETS of the system this runs on."""
    kind = "arm64" if platform.machine().lower() in ("arm64", "aarch64") else "x86_64"
    linux = {"x86_64": "linux", "arm64": "linux-arm64"}[kind]
    name = {"linux": linux, "win32": "windows", "darwin": f"macos-{kind}"}.get(sys.platform, sys.platform)
    if name not in TARGETS or (kind == "arm64" and "arm64" not in name):
        raise InputError(f"{sys.platform} on {platform.machine()}: binaries can be made for {', '.join(TARGETS)}")
    return name
