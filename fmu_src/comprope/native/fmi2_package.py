"""What is specific to the native FMU for FMI 2.0: model description and paths of binaries."""

import struct
import xml.etree.ElementTree as ET
from collections.abc import Mapping

from ..fmi.icon import icon
from ..fmi.model_description import complete_description
from ..fmi.model_interface import ModelInterface
from ..fmi.pythonfmu_slave import pythonfmu_description
from .fmi_version import FmiVersion
from .targets import TARGETS


def model_description(interface: ModelInterface, version: str, guid: str) -> bytes:
    """The model description: that of the FMU in Python, except for the capabilities of the binary."""
    root = ET.fromstring(complete_description(pythonfmu_description(interface), interface, version, guid))
    root.set("generationTool", f"comprope {version}")
    cosimulation = root.find("CoSimulation")
    assert cosimulation is not None
    cosimulation.attrib.update(needsExecutionTool="false", canNotUseMemoryManagementFunctions="false")
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def binary_files(name: str, binaries: Mapping[str, bytes]) -> dict[str, bytes]:
    """Binaries by their path in the FMU; those for several processors of one system are joined in one file."""
    found: dict[str, list[bytes]] = {}
    for target, binary in binaries.items():
        place = TARGETS[target]
        found.setdefault(f"binaries/{place.folder}/{name}.{place.extension}", []).append(binary)
    return {path: universal_binary(parts) if len(parts) > 1 else parts[0] for path, parts in found.items()}


_FAT_MAGIC, _ALIGNMENT = 0xCAFEBABE, 14  # powers of two; pages of 16 kB suit both processors


def universal_binary(parts: list[bytes]) -> bytes:
    """One file for macOS from binaries of several processors."""
    at, table, body = 1 << _ALIGNMENT, b"", b""
    for part in parts:
        processor, kind = struct.unpack_from("<II", part, 4)
        table += struct.pack(">IIIII", processor, kind, at, len(part), _ALIGNMENT)
        body += part + bytes(-len(part) % (1 << _ALIGNMENT))
        at = (1 << _ALIGNMENT) + len(body)
    head = struct.pack(">II", _FAT_MAGIC, len(parts)) + table
    return head + bytes((1 << _ALIGNMENT) - len(head)) + body


FMI2 = FmiVersion("2.0", "native", model_description, binary_files, lambda one: {"model.png": icon(one.icon)})
