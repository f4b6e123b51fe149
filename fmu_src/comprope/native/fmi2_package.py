"""The native FMU for FMI 2.0."""

import struct
import xml.etree.ElementTree as ET
from collections.abc import Mapping

from ..fmi.icon import icon
from ..fmi.model_description import completed
from ..fmi.model_interface import ModelInterface
from ..fmi.pythonfmu_slave import slave_class
from .fmi_version import Standard
from .targets import TARGETS


def description(interface: ModelInterface, version: str, guid: str) -> bytes:
    """The model description: that of the FMU in Python, but for what the binary itself can do."""
    slave = type(interface.name, (slave_class(interface),), {})(instance_name="one")
    root = ET.fromstring(completed(ET.tostring(slave.to_xml()), interface, version, guid))
    root.set("generationTool", f"comprope {version}")
    face = root.find("CoSimulation")
    assert face is not None
    face.attrib.update(needsExecutionTool="false", canNotUseMemoryManagementFunctions="false")
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def placed(name: str, binaries: Mapping[str, bytes]) -> dict[str, bytes]:
    """Binaries by their path in the FMU; those of several processors for one system go into one file."""
    found: dict[str, list[bytes]] = {}
    for target, binary in binaries.items():
        place = TARGETS[target]
        found.setdefault(f"binaries/{place.folder}/{name}.{place.extension}", []).append(binary)
    return {path: universal(parts) if len(parts) > 1 else parts[0] for path, parts in found.items()}


_FAT_MAGIC, _ALIGNMENT = 0xCAFEBABE, 14  # pages of 16 kB suit both processors


def universal(parts: list[bytes]) -> bytes:
    """One file for macOS from binaries of several processors."""
    at, table, body = 1 << _ALIGNMENT, b"", b""
    for part in parts:
        processor, kind = struct.unpack_from("<II", part, 4)
        table += struct.pack(">IIIII", processor, kind, at, len(part), _ALIGNMENT)
        body += part + bytes(-len(part) % (1 << _ALIGNMENT))
        at = (1 << _ALIGNMENT) + len(body)
    head = struct.pack(">II", _FAT_MAGIC, len(parts)) + table
    return head + bytes((1 << _ALIGNMENT) - len(head)) + body


FMI2 = Standard("2.0", "native", description, placed, lambda: {"model.png": icon()})
