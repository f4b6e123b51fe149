"""The native FMUs of rope and drive for this system, built once for a test run and kept by the content of its sources."""

import hashlib
from functools import cache
from pathlib import Path

import pytest

import comprope
from comprope.drive.cosimulation import interface as drive_interface
from comprope.errors import InputError
from comprope.fmi.model_interface import ModelInterface
from comprope.fmi.package import Origin
from comprope.native import linker
from comprope.native.drive_component import drive_component
from comprope.native.package import FMI_VERSIONS, build_native
from comprope.native.rope_component import rope_component
from comprope.rope.model_file import load
from comprope.rope.simulator.cosimulation import interface
from comprope.user_cache import entry_folder, verified_files
from comprope_system import presets

ORIGIN = Origin("1.2.3", "MIT")
# What native_host.c uses: two inputs, a parameter and an output.
HOSTED = {
    "CompensationRope": ("car_position", "counterweight_position", "sheave.mass", "lateral_displacement[1]"),
    "ElevatorDrive": ("car_end_tension", "counterweight_end_tension", "plant.car_mass", "car_position"),
}


def _compiler_missing() -> bool:
    try:
        linker.toolchain()
    except InputError:
        return True
    return False


compiler = pytest.mark.skipif(_compiler_missing(), reason="neither ziglang nor a C compiler is installed")


@cache
def tower() -> ModelInterface:
    """The 50 m test tower's rope."""
    return interface(load(presets.model_path("tower50")))


@cache
def drive() -> ModelInterface:
    """The drive with the declared values of its parameters."""
    return drive_interface()


@cache
def native_fmu(ending: str = "native", name: str = "CompensationRope") -> Path:
    """The FMU for FMI 2.0 or, ending in `native_fmi3`, for FMI 3.0; building those of rope and drive takes half a minute."""
    folder = entry_folder("tests", _digest())
    with verified_files(folder, "*.fmu"):
        if not (made := folder / f"{name}_{ending}.fmu").is_file():
            build_native(rope_component(tower()), folder, ORIGIN, FMI_VERSIONS, [linker.host_target()])
            build_native(drive_component(drive()), folder, ORIGIN, FMI_VERSIONS, [linker.host_target()])
    return made


def _digest() -> str:
    total = hashlib.sha256(linker.toolchain().encode())
    sources = Path(comprope.__file__).parent
    for file in sorted(path for path in sources.rglob("*") if path.suffix in (".py", ".c", ".h", ".html")):
        total.update(file.relative_to(sources).as_posix().encode() + b"\0" + file.read_bytes())
    return total.hexdigest()[:16]
