"""A system of FMUs in one file, after the standard SSP 1.0: which FMUs, what is connected, which parameters differ."""

import xml.etree.ElementTree as ET
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..atomic_files import atomic_write
from .model_interface import ModelInterface, Value, Variable
from .package import zipped

_NAMESPACES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
}
_TYPES = {"real": "Real", "integer": "Integer", "boolean": "Boolean", "string": "String"}


@dataclass(frozen=True)
class Part:
    """One FMU of a system: its name there, its file, its variables, and parameters that differ from the FMU's own."""

    name: str
    fmu: Path
    interface: ModelInterface
    parameters: Mapping[str, Value] = field(default_factory=dict)


@dataclass(frozen=True)
class Wire:
    """From the output of one part to the input of another; each is (part, variable)."""

    start: tuple[str, str]
    end: tuple[str, str]


def wires_by_name(parts: Iterable[Part]) -> list[Wire]:
    """A wire for every input that bears the name of another part's output."""
    chosen = list(parts)
    outputs = {one.name: part.name for part in chosen for one in part.interface.of_role("output")}
    inputs = [(part.name, one.name) for part in chosen for one in part.interface.of_role("input")]
    return [Wire((outputs[name], name), (part, name)) for part, name in inputs if outputs.get(name, part) != part]


def write_ssp(path: Path, name: str, parts: Iterable[Part], wires: Iterable[Wire]) -> Path:
    """Write the archive, whole or not at all; the same arguments give the same bytes. Returns its path."""
    chosen = list(parts)
    content = {f"resources/{part.fmu.name}": part.fmu.read_bytes() for part in chosen}
    with atomic_write(path) as temporary:
        temporary.write_bytes(zipped(content | {"SystemStructure.ssd": structure(name, chosen, wires)}))
    return path


def structure(name: str, parts: Iterable[Part], wires: Iterable[Wire]) -> bytes:
    """The system's description, `SystemStructure.ssd`."""
    for prefix, uri in _NAMESPACES.items():
        ET.register_namespace(prefix, uri)
    root = ET.Element(_tag("ssd:SystemStructureDescription"), version="1.0", name=name)
    system = ET.SubElement(root, _tag("ssd:System"), name=name)
    elements = ET.SubElement(system, _tag("ssd:Elements"))
    chosen = list(wires)
    for part in parts:
        _add_part(elements, part, {target for end, target in (wire.end for wire in chosen) if end == part.name})
    connections = ET.SubElement(system, _tag("ssd:Connections"))
    for wire in chosen:
        (start, output), (end, target) = wire.start, wire.end
        ends = {"startElement": start, "startConnector": output, "endElement": end, "endConnector": target}
        ET.SubElement(connections, _tag("ssd:Connection"), ends)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _tag(name: str) -> str:
    prefix, _, local = name.partition(":")
    return f"{{{_NAMESPACES[prefix]}}}{local}"


def _add_part(elements: ET.Element, part: Part, wired: Collection[str]) -> None:
    """Describe a part; an input that nothing is connected to keeps its start value and is left out."""
    source = {"name": part.name, "type": "application/x-fmu-sharedlibrary", "source": f"resources/{part.fmu.name}"}
    component = ET.SubElement(elements, _tag("ssd:Component"), source)
    connectors = ET.SubElement(component, _tag("ssd:Connectors"))
    inputs = [one for one in part.interface.of_role("input") if one.name in wired]
    for one in (*inputs, *part.interface.of_role("output")):
        connector = ET.SubElement(connectors, _tag("ssd:Connector"), name=one.name, kind=one.role)
        ET.SubElement(connector, _tag(f"ssc:{_TYPES[one.kind]}"), _unit(one))
    if part.parameters:
        _add_parameters(component, part.parameters)


def _unit(variable: Variable) -> dict[str, str]:
    return {"unit": variable.unit} if variable.kind == "real" and variable.unit != "1" else {}


def _add_parameters(component: ET.Element, parameters: Mapping[str, Value]) -> None:
    bindings = ET.SubElement(component, _tag("ssd:ParameterBindings"))
    values = ET.SubElement(ET.SubElement(bindings, _tag("ssd:ParameterBinding")), _tag("ssd:ParameterValues"))
    chosen = ET.SubElement(ET.SubElement(values, _tag("ssv:ParameterSet"), version="1.0", name="own"), _tag("ssv:Parameters"))
    for name, value in parameters.items():
        kind = "Boolean" if isinstance(value, bool) else "Real"
        parameter = ET.SubElement(chosen, _tag("ssv:Parameter"), name=name)
        ET.SubElement(parameter, _tag(f"ssv:{kind}"), value=str(value).lower())
