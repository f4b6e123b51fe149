"""What is specific to the native FMU for FMI 3.0: arrays of what FMI 2.0 has in scalars, and the time."""

import xml.etree.ElementTree as ET
from collections.abc import Mapping

from ..fmi.arrays import Group, groups_of, places_of
from ..fmi.icon import SIZE, icon
from ..fmi.model_description import (
    default_experiment,
    dependencies,
    general_attributes,
    type_attributes,
    unit_definitions,
)
from ..fmi.model_interface import ModelInterface
from .fmi_version import FmiVersion
from .targets import TARGETS

_TYPES = {"real": "Float64", "integer": "Int32", "boolean": "Boolean"}
_INITIAL = {"parameter": {"initial": "exact"}, "output": {"initial": "calculated"}, "input": {}}
_ABLE = ("canGetAndSetFMUState", "canSerializeFMUState", "canHandleVariableCommunicationStepSize")


def model_description(interface: ModelInterface, version: str, token: str) -> bytes:
    """The model description, from the same declarations as that for FMI 2.0."""
    given = {"fmiVersion": "3.0", "modelName": interface.name, "instantiationToken": token}
    given |= general_attributes(interface, version)
    root = ET.Element("fmiModelDescription", given | {"variableNamingConvention": "structured"})
    ET.SubElement(root, "CoSimulation", {"modelIdentifier": interface.name} | dict.fromkeys(_ABLE, "true"))
    root.append(unit_definitions(interface.variables))
    categories = ET.SubElement(root, "LogCategories")
    ET.SubElement(categories, "Category", name="logStatusError", description="Calls refused and steps that failed, in a sentence")
    root.append(default_experiment(interface))
    variables = ET.SubElement(root, "ModelVariables")
    groups = groups_of(interface)
    for group in groups:
        element = ET.SubElement(variables, _TYPES[group.variable.kind], _attributes(group))
        if group.is_array:
            ET.SubElement(element, "Dimension", start=str(len(group.elements)))
    ET.SubElement(variables, "Float64", _time(len(interface.variables)))
    _add_structure(ET.SubElement(root, "ModelStructure"), interface, groups)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _attributes(group: Group) -> dict[str, str]:
    variable = group.variable
    given = {"name": variable.name, "valueReference": str(group.place), "description": variable.help}
    kind = {"causality": variable.role, "variability": variable.variability}
    attributes = given | kind | _INITIAL[variable.role] | type_attributes(variable)
    starts = [found for one in group.elements if (found := type_attributes(one).get("start")) is not None]
    return attributes | ({"start": " ".join(starts)} if starts else {})


def _time(place: int) -> dict[str, str]:
    """The independent variable, which FMI 3.0 requires."""
    given = {"name": "time", "valueReference": str(place), "description": "time reached"}
    return given | {"causality": "independent", "variability": "continuous", "unit": "s"}


def _add_structure(structure: ET.Element, interface: ModelInterface, groups: tuple[Group, ...]) -> None:
    """List every output with its dependencies on inputs while stepping, and as an initial unknown."""
    places = places_of(groups)
    found = [dependencies(interface, one.elements[0], places) for one in groups if one.variable.role == "output"]
    for place, stepping, _ in found:
        ET.SubElement(structure, "Output", {"valueReference": place} | stepping)
    for place, _, initially in found:
        ET.SubElement(structure, "InitialUnknown", {"valueReference": place} | initially)


def binary_files(name: str, binaries: Mapping[str, bytes]) -> dict[str, bytes]:
    """Binaries by their path in the FMU."""
    places = {target: TARGETS[target] for target in binaries}
    return {f"binaries/{one.platform}/{name}.{one.extension}": binaries[target] for target, one in places.items()}


def icon_files(interface: ModelInterface) -> dict[str, bytes]:
    """The icon, and the file that declares it and the terminals."""
    root = ET.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    picture = ET.SubElement(root, "GraphicalRepresentation")
    corners = {"x1": "0", "y1": "0", "x2": str(SIZE), "y2": str(SIZE)}
    ET.SubElement(picture, "CoordinateSystem", corners | {"suggestedScalingFactorTo_mm": "0.1"})
    ET.SubElement(picture, "Icon", corners)
    if interface.terminals:
        terminals = ET.SubElement(root, "Terminals")
        for one in interface.terminals:
            given = {"name": one.name, "matchingRule": "plug", "description": one.help}
            terminal = ET.SubElement(terminals, "Terminal", given)
            for name in one.members:
                member = {"variableName": name, "memberName": name, "variableKind": "signal"}
                ET.SubElement(terminal, "TerminalMemberVariable", member)
    ET.indent(root)
    text = ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
    return {"terminalsAndIcons/terminalsAndIcons.xml": text, "terminalsAndIcons/icon.png": icon(interface.icon)}


FMI3 = FmiVersion("3.0", "native_fmi3", model_description, binary_files, icon_files)
