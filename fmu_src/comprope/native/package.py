"""Build the FMU of rope or drive without Python: the same kernels, compiled, with the functions of the FMI in C.

Variables, documentation and icon have the same sources as those of the FMU that runs in Python. The FMUs for all versions
of the FMI standard share one set of binaries.
"""

import uuid
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..atomic_files import atomic_write
from ..errors import InputError
from ..fmi.documentation import documentation_page
from ..fmi.model_interface import ModelInterface
from ..fmi.package import DESCRIPTION, Origin, digest, reproducible_zip
from ..fmi.reference_result import reference_result
from ..fmi.validation import interface_problems
from . import linker
from .c_source import kernels_header, model_source
from .component import Component
from .fmi2_package import FMI2
from .fmi3_package import FMI3
from .fmi_version import FmiVersion
from .llvm_ir import kernels
from .targets import TARGETS, machine_code

FMI_VERSIONS = (FMI2, FMI3)


def build_native(
    component: Component,
    out: Path,
    origin: Origin,
    versions: Sequence[FmiVersion] = (FMI2,),
    targets: Sequence[str] = (),
) -> list[Path]:
    """Write `<out>/<name>_<ending of the version>.fmu` for each version, atomically, and return their paths.

    They have binaries for `targets` (see `targets.TARGETS`), by default all that can be linked for on this system, and the C
    sources of the functions of the FMI for reading. The same sources and tools give the same bytes.
    """
    interface = component.interface
    if problems := interface_problems(interface):
        raise InputError("; ".join(problems))
    code, chosen = kernels(component.name, component.effect_files), list(targets) or linker.linkable_targets()
    compiled = {name: machine_code(code, TARGETS[name]) for name in chosen}
    shared = reference_result(interface)
    shared |= {f"documentation/c/{name}": content for name, content in linker.c_sources(component.name).items()}
    identity = _identities(component, origin, shared | {f"kernels/{name}": one for name, one in compiled.items()})
    binaries = linker.link_binaries(interface.name, compiled, _sources(component, identity[FMI2], identity[FMI3]))
    for one in versions:
        own = _version_files(one, interface, origin, identity[one], linker.system_names(chosen))
        own |= one.binary_files(interface.name, binaries)
        with atomic_write(out / _file_name(interface, one)) as path:
            path.write_bytes(reproducible_zip(shared | own))
    return [out / _file_name(interface, one) for one in versions]


def _sources(component: Component, guid: str, token: str) -> dict[str, bytes]:
    """The C files by name, those that are generated among them."""
    generated = {"kernels.h": kernels_header(component), "model_variables.c": model_source(component.interface, guid, token)}
    return linker.c_sources(component.name) | {name: text.encode() for name, text in generated.items()}


def _file_name(interface: ModelInterface, version: FmiVersion) -> str:
    return f"{interface.name}_{version.ending}.fmu"


def _identities(component: Component, origin: Origin, parts: Mapping[str, bytes]) -> dict[FmiVersion, str]:
    """GUID and instantiation token: hashes of all sources of the FMUs and of the compiler."""
    interface = component.interface
    sources = {f"c/{name}": content for name, content in _sources(component, "", "").items()}
    sources |= {**parts, "compiler": linker.toolchain().encode()}
    for one in FMI_VERSIONS:
        own = _version_files(one, interface, origin, identity="", systems="")
        sources |= {f"{one.version}/{name}": content for name, content in own.items()}
    found = digest(sources)
    return {FMI2: str(uuid.UUID(found[:32])), FMI3: str(uuid.UUID(found[32:]))}


def _version_files(
    version: FmiVersion, interface: ModelInterface, origin: Origin, identity: str, systems: str
) -> dict[str, bytes]:
    """The files of the FMU that are specific to one version of the FMI standard, except binaries."""
    return {
        DESCRIPTION: version.model_description(interface, origin.version, identity),
        "documentation/index.html": documentation_page(interface, origin.version, fmi=version.version, systems=systems).encode(),
        "documentation/licenses/license.txt": origin.licence.encode(),
        "documentation/licenses/fmi-headers.txt": "\n\n".join(map(_licence, _HEADERS)).encode(),
        **version.icon_files(interface),
    }


_HEADERS = ("fmi2TypesPlatform.h", "fmi3PlatformTypes.h")


def _licence(header: str) -> str:
    """The licence text at the top of one of the headers of the FMI standard."""
    text = (linker.HEADERS / header).read_text("utf-8")
    return text[text.index("Copyright") : text.index("*/", text.index("Copyright"))].rstrip()
