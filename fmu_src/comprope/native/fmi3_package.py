"""The native FMU for FMI 3.0: the same variables, with the same value references, and the time besides."""

import xml.etree.ElementTree as ET
from collections.abc import Mapping

from ..fmi.icon import SIZE, icon
from ..fmi.model_description import about, default_experiment, type_attributes, unit_definitions
from ..fmi.model_interface import ModelInterface, Variable
from .fmi_version import Standard
from .targets import TARGETS

_TYPES = {"real": "Float64", "integer": "Int32", "boolean": "Boolean"}
_INITIAL = {"parameter": {"initial": "exact"}, "output": {"initial": "calculated"}, "input": {}}
_ABLE = ("canGetAndSetFMUState", "canSerializeFMUState", "canHandleVariableCommunicationStepSize")


def description(interface: ModelInterface, version: str, token: str) -> bytes:
    """The model description, from the same declarations as that for FMI 2.0."""
    given = {"fmiVersion": "3.0", "modelName": interface.name, "instantiationToken": token} | about(interface, version)
    root = ET.Element("fmiModelDescription", given | {"variableNamingConvention": "structured"})
    ET.SubElement(root, "CoSimulation", {"modelIdentifier": interface.name} | dict.fromkeys(_ABLE, "true"))
    root.append(unit_definitions(interface.variables))
    root.append(default_experiment(interface))
    variables = ET.SubElement(root, "ModelVariables")
    for place, one in enumerate(interface.variables):
        ET.SubElement(variables, _TYPES[one.kind], _attributes(one, place))
    ET.SubElement(variables, "Float64", _time(len(interface.variables)))
    _add_structure(ET.SubElement(root, "ModelStructure"), interface)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _attributes(variable: Variable, place: int) -> dict[str, str]:
    given = {"name": variable.name, "valueReference": str(place), "description": variable.help}
    kind = {"causality": variable.role, "variability": variable.variability}
    return given | kind | _INITIAL[variable.role] | type_attributes(variable)


def _time(place: int) -> dict[str, str]:
    """The independent variable, which FMI 3.0 demands."""
    given = {"name": "time", "valueReference": str(place), "description": "time reached"}
    return given | {"causality": "independent", "variability": "continuous", "unit": "s"}


def _add_structure(structure: ET.Element, interface: ModelInterface) -> None:
    """List every output as it depends on inputs while stepping, and as one that at the start depends on everything."""
    places = {one.name: place for place, one in enumerate(interface.variables)}
    outputs = interface.of_role("output")
    for one in outputs:
        depends_on = " ".join(str(place) for place in sorted(places[name] for name in one.depends_on))
        ET.SubElement(structure, "Output", valueReference=str(places[one.name]), dependencies=depends_on)
    for one in outputs:
        ET.SubElement(structure, "InitialUnknown", valueReference=str(places[one.name]))


def placed(name: str, binaries: Mapping[str, bytes]) -> dict[str, bytes]:
    """Binaries by their path in the FMU."""
    places = {target: TARGETS[target] for target in binaries}
    return {f"binaries/{one.platform}/{name}.{one.extension}": binaries[target] for target, one in places.items()}


def icons() -> dict[str, bytes]:
    """The icon, and the file that says that there is one."""
    root = ET.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    picture = ET.SubElement(root, "GraphicalRepresentation")
    corners = {"x1": "0", "y1": "0", "x2": str(SIZE), "y2": str(SIZE)}
    ET.SubElement(picture, "CoordinateSystem", corners | {"suggestedScalingFactorTo_mm": "0.1"})
    ET.SubElement(picture, "Icon", corners)
    ET.indent(root)
    text = ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
    return {"terminalsAndIcons/terminalsAndIcons.xml": text, "terminalsAndIcons/icon.png": icon()}


FMI3 = Standard("3.0", "native-fmi3", description, placed, icons)
