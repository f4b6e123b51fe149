"""Build the rope's FMU that needs no Python: the same kernels, compiled, behind a small face in C.

Variables, documentation and icon come from where those of the FMU that runs in Python come from. One set of binaries
serves the FMUs for all versions of the FMI standard.
"""

import uuid
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..atomic_files import atomic_write
from ..errors import InputError
from ..fmi.documentation import page
from ..fmi.model_interface import ModelInterface
from ..fmi.package import DESCRIPTION, Origin, digest, zipped
from ..fmi.reference_result import reference
from ..fmi.validation import interface_problems
from ..rope.effects.user_effects import FILES
from . import linker
from .c_source import effects_of, kernels_header, model_source
from .fmi2_package import FMI2
from .fmi3_package import FMI3
from .fmi_version import Standard
from .llvm_ir import kernels, sizes
from .targets import TARGETS, machine_code

STANDARDS = (FMI2, FMI3)


def build_native(
    interface: ModelInterface,
    out: Path,
    origin: Origin,
    standards: Sequence[Standard] = (FMI2,),
    targets: Sequence[str] = (),
) -> list[Path]:
    """Write `<out>/<name>-native.fmu`, or what `standards` call it, each whole or not at all, and return their paths.

    They have binaries for `targets` (see `machine.TARGETS`), by default all that can be linked for here. The
    effects that the model may have are compiled in, a user's own as well. The same sources and tools give the same bytes.
    """
    if problems := interface_problems(interface):
        raise InputError("; ".join(problems))
    files, chosen = own_files(interface), list(targets) or linker.linkable()
    code, header = kernels(files), kernels_header(interface, sizes(files))
    compiled = {name: machine_code(code, TARGETS[name]) for name in chosen}
    shared = reference(interface)
    identity = _identity(interface, origin, header, shared | {f"kernels/{name}": one for name, one in compiled.items()})
    model = model_source(interface, identity[FMI2], identity[FMI3])
    binaries = linker.binaries(interface.name, compiled, {"kernels.h": header, "model.c": model})
    for one in standards:
        own = _own(one, interface, origin, identity[one], linker.systems(chosen)) | one.placed(interface.name, binaries)
        with atomic_write(out / _file_name(interface, one)) as path:
            path.write_bytes(zipped(shared | own))
    return [out / _file_name(interface, one) for one in standards]


def _file_name(interface: ModelInterface, standard: Standard) -> str:
    return f"{interface.name}-{standard.ending}.fmu"


def own_files(interface: ModelInterface) -> dict[str, str]:
    """Sources of the user's own effects that a rope may have by path, in the order in which they were first run."""
    return {one.source: FILES[one.source].text for one in effects_of(interface) if one.source}


def _identity(interface: ModelInterface, origin: Origin, header: str, parts: Mapping[str, bytes]) -> dict[Standard, str]:
    """GUID and instantiation token: they follow from all that the FMUs are made of, and from what compiles them."""
    generated = {"kernels.h": header, "model.c": model_source(interface, "", ""), "compiler": linker.toolchain()}
    sources = {f"face/{name}": content for name, content in (linker.face_sources() | dict(parts)).items()}
    sources |= {name: text.encode() for name, text in generated.items()}
    for one in STANDARDS:
        own = _own(one, interface, origin, identity="", systems="")
        sources |= {f"{one.version}/{name}": content for name, content in own.items()}
    found = digest(sources)
    return {FMI2: str(uuid.UUID(found[:32])), FMI3: str(uuid.UUID(found[32:]))}


def _own(standard: Standard, interface: ModelInterface, origin: Origin, identity: str, systems: str) -> dict[str, bytes]:
    """What the FMU for one version of the standard does not share with others, but for the places of the binaries."""
    return {
        DESCRIPTION: standard.description(interface, origin.version, identity),
        "documentation/index.html": page(interface, origin.version, fmi=standard.version, systems=systems).encode(),
        "documentation/licenses/license.txt": origin.licence.encode(),
        "documentation/licenses/fmi-headers.txt": "\n\n".join(map(_licence, _HEADERS)).encode(),
        **standard.icons(),
    }


_HEADERS = ("fmi2TypesPlatform.h", "fmi3PlatformTypes.h")


def _licence(header: str) -> str:
    """The licence of one of the FMI standard's headers, as it stands at its top."""
    text = (linker.HEADERS / header).read_text("utf-8")
    return text[text.index("Copyright") : text.index("*/", text.index("Copyright"))].rstrip()
