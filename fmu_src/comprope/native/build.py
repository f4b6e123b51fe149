"""Build the rope's FMU that needs no Python: the same kernels, compiled, behind a small face in C.

Model description, documentation and icon come from where those of the FMU that runs in Python come from.
"""

import uuid
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..errors import InputError
from ..fmi.build import DESCRIPTION, Origin, digest, zipped
from ..fmi.check import interface_problems
from ..fmi.description import completed
from ..fmi.engine import ModelInterface
from ..fmi.face import slave_class
from ..fmi.icon import icon
from ..fmi.page import page
from ..rope.effects.own import FILES
from ..whole import whole_file
from . import link
from .ir import kernels, sizes
from .machine import TARGETS, machine_code
from .reference import reference
from .tables import effects_of, kernels_header, model_source


def build_native(interface: ModelInterface, out: Path, origin: Origin, targets: Sequence[str] = ()) -> Path:
    """Write `<out>/<name>-native.fmu`, whole or not at all, and return its path.

    It has binaries for `targets` (see `machine.TARGETS`), by default all that can be linked for here. The
    effects that the model may have are compiled in, a user's own as well. The same sources and tools give the same bytes.
    """
    if problems := interface_problems(interface):
        raise InputError("; ".join(problems))
    files, chosen = own_files(interface), list(targets) or link.linkable()
    code, header = kernels(files), kernels_header(interface, sizes(files))
    compiled = {name: machine_code(code, TARGETS[name]) for name in chosen}
    content = reference(interface) | _documentation(interface, origin, link.systems(chosen))
    parts = {f"kernels/{name}": one for name, one in compiled.items()} | content
    guid = _identity(interface, origin.version, header, parts)
    content[DESCRIPTION] = description(interface, origin.version, guid)
    content |= link.binaries(interface.name, compiled, {"kernels.h": header, "model.c": model_source(interface, guid)})
    path = out / f"{interface.name}-native.fmu"
    with whole_file(path) as temporary:
        temporary.write_bytes(zipped(content))
    return path


def own_files(interface: ModelInterface) -> dict[str, str]:
    """Sources of the user's own effects that a rope may have by path, in the order in which they were first run."""
    return {one.source: FILES[one.source].text for one in effects_of(interface) if one.source}


def description(interface: ModelInterface, version: str, guid: str) -> bytes:
    """The model description: that of the FMU in Python, but for what the binary itself can do."""
    slave = type(interface.name, (slave_class(interface),), {})(instance_name="one")
    root = ET.fromstring(completed(ET.tostring(slave.to_xml()), interface, version, guid))
    root.set("generationTool", f"comprope {version}")
    face = root.find("CoSimulation")
    assert face is not None
    face.attrib.update(needsExecutionTool="false", canNotUseMemoryManagementFunctions="false")
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _identity(interface: ModelInterface, version: str, header: str, parts: Mapping[str, bytes]) -> str:
    """The GUID: it follows from all that the FMU is made of, and from what compiles it."""
    generated = {"kernels.h": header, "model.c": model_source(interface, ""), "compiler": link.toolchain()}
    sources = {f"face/{name}": content for name, content in (link.face_sources() | dict(parts)).items()}
    sources |= {name: text.encode() for name, text in generated.items()}
    return str(uuid.UUID(digest(sources | {DESCRIPTION: description(interface, version, "")})[:32]))


def _documentation(interface: ModelInterface, origin: Origin, systems: str) -> dict[str, bytes]:
    return {
        "model.png": icon(),
        "documentation/index.html": page(interface, origin.version, systems=systems).encode(),
        "documentation/licenses/license.txt": origin.licence.encode(),
        "documentation/licenses/fmi-headers.txt": _header_licence().encode(),
    }


def _header_licence() -> str:
    """The licence of the FMI standard's headers, as it stands at their top."""
    text = (link.HEADERS / "fmi2TypesPlatform.h").read_text("utf-8")
    return text[text.index("Copyright") : text.index("*/")]
