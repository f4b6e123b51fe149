"""A system of FMUs in one file after the standard SSP 1.0: components, connections, parameters, units, default experiment."""

import xml.etree.ElementTree as ET
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..atomic_files import atomic_write
from .model_interface import ModelInterface, Value, Variable
from .package import reproducible_zip
from .units import exponents

_NAMESPACES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
    "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
}
_TYPES = {"real": "Real", "integer": "Integer", "boolean": "Boolean", "string": "String"}


@dataclass(frozen=True)
class Component:
    """One FMU of a system: its name, its file, its variables, and parameters that differ from the FMU's own.

    `exposed` are inputs that belong to the whole system.
    """

    name: str
    fmu: Path
    interface: ModelInterface
    parameters: Mapping[str, Value] = field(default_factory=dict)
    exposed: tuple[str, ...] = ()


@dataclass(frozen=True)
class Connection:
    """From the output of one component to the input of another; each is (component, variable)."""

    start: tuple[str, str]
    end: tuple[str, str]


def connections_by_name(components: Iterable[Component]) -> list[Connection]:
    """A connection for every input that has the name of another component's output."""
    chosen = list(components)
    outputs = {one.name: component.name for component in chosen for one in component.interface.of_role("output")}
    inputs = [(component.name, one.name) for component in chosen for one in component.interface.of_role("input")]
    connected = [(owner, name) for owner, name in inputs if outputs.get(name, owner) != owner]
    return [Connection((outputs[name], name), (owner, name)) for owner, name in connected]


def write_ssp(path: Path, name: str, components: Iterable[Component], connections: Iterable[Connection]) -> Path:
    """Write the archive atomically; the same arguments give the same bytes. Returns its path.

    Inputs that nothing is connected to are inputs of the whole system too, if their components name them in `exposed`.
    """
    chosen = list(components)
    content = {f"resources/{component.fmu.name}": component.fmu.read_bytes() for component in chosen}
    with atomic_write(path) as temporary:
        temporary.write_bytes(reproducible_zip(content | {"SystemStructure.ssd": structure(name, chosen, connections)}))
    return path


def structure(name: str, components: Iterable[Component], connections: Iterable[Connection]) -> bytes:
    """The system's description, `SystemStructure.ssd`."""
    for prefix, uri in _NAMESPACES.items():
        ET.register_namespace(prefix, uri)
    root = ET.Element(_tag("ssd:SystemStructureDescription"), version="1.0", name=name)
    system = ET.SubElement(root, _tag("ssd:System"), name=name)
    parts = list(components)
    exposed = [(part.name, one) for part in parts for one in part.interface.of_role("input") if one.name in part.exposed]
    if exposed:
        _add_connectors(system, [one for _, one in exposed])
    elements = ET.SubElement(system, _tag("ssd:Elements"))
    chosen = [*(Connection(("", one.name), (owner, one.name)) for owner, one in exposed), *connections]
    for component in parts:
        _add_component(elements, component, {target for end, target in (one.end for one in chosen) if end == component.name})
    listed = ET.SubElement(system, _tag("ssd:Connections"))
    for connection in chosen:
        (start, output), (end, target) = connection.start, connection.end
        ends = {"startElement": start, "startConnector": output, "endElement": end, "endConnector": target}
        ET.SubElement(listed, _tag("ssd:Connection"), {key: value for key, value in ends.items() if value})
    _add_master(system, max(part.interface.step_size for part in parts))
    _add_units(root, [one for part in parts for one in part.interface.variables])
    stop = max(part.interface.stop_time for part in parts)
    ET.SubElement(root, _tag("ssd:DefaultExperiment"), startTime="0.0", stopTime=repr(stop))
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _tag(name: str) -> str:
    prefix, _, local = name.partition(":")
    return f"{{{_NAMESPACES[prefix]}}}{local}"


def _add_component(elements: ET.Element, component: Component, connected: Collection[str]) -> None:
    """Add a component to the description; an unconnected input keeps its start value and is omitted."""
    source = {"name": component.name, "type": "application/x-fmu-sharedlibrary", "source": f"resources/{component.fmu.name}"}
    element = ET.SubElement(elements, _tag("ssd:Component"), source)
    inputs = [one for one in component.interface.of_role("input") if one.name in connected]
    _add_connectors(element, [*inputs, *component.interface.of_role("output")])
    if component.parameters:
        _add_parameters(element, component.parameters)


def _add_connectors(element: ET.Element, variables: Iterable[Variable]) -> None:
    connectors = ET.SubElement(element, _tag("ssd:Connectors"))
    for one in variables:
        connector = ET.SubElement(connectors, _tag("ssd:Connector"), name=one.name, kind=one.role)
        ET.SubElement(connector, _tag(f"ssc:{_TYPES[one.kind]}"), _unit(one))


def _add_master(system: ET.Element, step: float) -> None:
    """Add the annotation from which OMSimulator takes its master: co-simulation in fixed steps [s]."""
    annotations = ET.SubElement(system, _tag("ssd:Annotations"))
    annotation = ET.SubElement(annotations, _tag("ssc:Annotation"), type="org.openmodelica")
    information = ET.SubElement(ET.SubElement(annotation, _tag("oms:Annotations")), _tag("oms:SimulationInformation"))
    tolerances = {"absoluteTolerance": "0.0001", "relativeTolerance": "0.0001"}  # required there, of no effect on fixed steps
    ET.SubElement(information, _tag("oms:FixedStepMaster"), {"description": "oms-ma", "stepSize": repr(step)} | tolerances)


def _add_units(root: ET.Element, variables: Iterable[Variable]) -> None:
    """Add the units that connectors refer to, in base units."""
    units = ET.SubElement(root, _tag("ssd:Units"))
    for name in sorted({one.unit for one in variables if one.kind == "real" and one.unit != "1"}):
        unit = ET.SubElement(units, _tag("ssc:Unit"), name=name)
        ET.SubElement(unit, _tag("ssc:BaseUnit"), {base: str(power) for base, power in exponents(name).items()})


def _unit(variable: Variable) -> dict[str, str]:
    return {"unit": variable.unit} if variable.kind == "real" and variable.unit != "1" else {}


def _add_parameters(element: ET.Element, parameters: Mapping[str, Value]) -> None:
    bindings = ET.SubElement(element, _tag("ssd:ParameterBindings"))
    values = ET.SubElement(ET.SubElement(bindings, _tag("ssd:ParameterBinding")), _tag("ssd:ParameterValues"))
    parameter_set = ET.SubElement(values, _tag("ssv:ParameterSet"), version="1.0", name="own")
    chosen = ET.SubElement(parameter_set, _tag("ssv:Parameters"))
    for name, value in parameters.items():
        kind = "Boolean" if isinstance(value, bool) else "Real"
        parameter = ET.SubElement(chosen, _tag("ssv:Parameter"), name=name)
        ET.SubElement(parameter, _tag(f"ssv:{kind}"), value=str(value).lower())
    # Optional, but pyssp-standard 0.9 writes no set back that has none.
    unit = ET.SubElement(ET.SubElement(parameter_set, _tag("ssv:Units")), _tag("ssc:Unit"), name="1")
    ET.SubElement(unit, _tag("ssc:BaseUnit"))
