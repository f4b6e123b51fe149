"""Model descriptions: completes that of pythonfmu with units, ranges, dependencies and identity.

pythonfmu 0.7.0 omits these and InitialUnknowns, which the standard requires, and rounds start values to 16 digits, which
does not preserve every number.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping

from .model_interface import ModelInterface, Value, Variable
from .units import display_factor, exponents

FIXED_DATE = "1980-01-01T00:00:00Z"
_CAPABILITIES = ("canGetAndSetFMUstate", "canSerializeFMUstate", "canHandleVariableCommunicationStepSize")


def complete_description(xml: bytes, interface: ModelInterface, version: str, guid: str) -> bytes:
    """The model description of `interface`, from the one pythonfmu wrote; the same for the same arguments."""
    root = ET.fromstring(xml)
    tool = f"comprope {version}, {root.get('generationTool')}"
    root.attrib.update(guid=guid, **general_attributes(interface, version) | {"generationTool": tool})
    _required_child(root, "CoSimulation").attrib.update(dict.fromkeys(_CAPABILITIES, "true"))
    root.insert(1, unit_definitions(interface.variables))
    root.insert(list(root).index(_required_child(root, "ModelVariables")), default_experiment(interface))
    for element, variable in zip(_required_child(root, "ModelVariables"), interface.variables, strict=True):
        element[0].attrib.update(type_attributes(variable))
    _rebuild_structure(_required_child(root, "ModelStructure"), interface)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def general_attributes(interface: ModelInterface, version: str) -> dict[str, str]:
    """Description and origin of an FMU, in attributes that every version of FMI has."""
    return {
        "description": interface.description,
        "author": "comprope",
        "version": version,
        "copyright": "Copyright (c) the comprope authors",
        "license": "MIT; see documentation/licenses",
        "generationTool": f"comprope {version}",
        "generationDateAndTime": FIXED_DATE,
    }


def _required_child(root: ET.Element, tag: str) -> ET.Element:
    found = root.find(tag)
    if found is None:
        raise ValueError(f"pythonfmu wrote a model description without {tag}")
    return found


def unit_definitions(variables: Iterable[Variable]) -> ET.Element:
    """The units of real variables in base units, with their display units."""
    displays: dict[str, set[str]] = {}
    for one in variables:
        if one.kind == "real":
            displays.setdefault(one.unit, set()).update([one.display_unit] if one.display_unit else [])
    definitions = ET.Element("UnitDefinitions")
    for unit in sorted(displays):
        element = ET.SubElement(definitions, "Unit", name=unit)
        ET.SubElement(element, "BaseUnit", {base: str(power) for base, power in exponents(unit).items()})
        for display in sorted(displays[unit]):
            ET.SubElement(element, "DisplayUnit", name=display, factor=repr(display_factor(display, unit)))
    return definitions


def default_experiment(interface: ModelInterface) -> ET.Element:
    """Start time, stop time and step size that an importer uses by default."""
    times = {"startTime": 0.0, "stopTime": interface.stop_time, "stepSize": interface.step_size}
    return ET.Element("DefaultExperiment", {name: repr(value) for name, value in times.items()})


def type_attributes(variable: Variable) -> dict[str, str]:
    """Attributes of the type element: start value; of numbers also range, unit and nominal value."""
    found: dict[str, Value | None] = {"start": variable.start}
    if variable.kind in ("real", "integer"):
        found |= {"min": variable.minimum, "max": variable.maximum}
    texts = {name: _text(variable.cast(value)) for name, value in found.items() if value is not None}
    if variable.kind == "real":
        texts |= {"unit": variable.unit}
        texts |= {"nominal": _text(abs(variable.nominal))} if variable.nominal else {}
        texts |= {"displayUnit": variable.display_unit} if variable.display_unit else {}
    return texts


def _text(value: Value) -> str:
    return value if isinstance(value, str) else repr(value).lower()


def _rebuild_structure(structure: ET.Element, interface: ModelInterface) -> None:
    """List every output twice: with its dependencies on inputs while stepping, and as an initial unknown."""
    structure.clear()
    outputs = interface.of_role("output")
    if not outputs:
        return
    places = {one.name: place for place, one in enumerate(interface.variables, 1)}
    while_stepping, at_start = (ET.SubElement(structure, tag) for tag in ("Outputs", "InitialUnknowns"))
    for one in outputs:
        index, stepping, initially = dependencies(interface, one, places)
        ET.SubElement(while_stepping, "Unknown", {"index": index} | stepping)
        ET.SubElement(at_start, "Unknown", {"index": index} | initially)


def dependencies(
    interface: ModelInterface, output: Variable, places: Mapping[str, int]
) -> tuple[str, dict[str, str], dict[str, str]]:
    """The place of an output, and the attribute with what it depends on: while stepping, and at the start.

    `places` are the indices or value references of all variables. At the start every output may depend on every parameter; the
    attribute is absent where it is not known which inputs matter.
    """
    parameters = [one.name for one in interface.of_role("parameter")]

    def attribute(names: Iterable[str]) -> dict[str, str]:
        return {"dependencies": " ".join(map(str, sorted({places[name] for name in names})))}

    known = output.initial_depends_on
    return str(places[output.name]), attribute(output.depends_on), {} if known is None else attribute([*parameters, *known])
