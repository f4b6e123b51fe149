"""Complete the model description that pythonfmu writes: units, ranges, dependencies, identity.

pythonfmu 0.7.0 leaves out all that and InitialUnknowns, which the standard demands, and rounds
start values to 16 digits, which does not bring every number back.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterable

from .model_interface import ModelInterface, Value, Variable
from .units import display_factor, exponents

FIXED_DATE = "1980-01-01T00:00:00Z"
_CAPABILITIES = ("canGetAndSetFMUstate", "canSerializeFMUstate", "canHandleVariableCommunicationStepSize")


def completed(xml: bytes, interface: ModelInterface, version: str, guid: str) -> bytes:
    """The model description of `interface`, from the one pythonfmu wrote; the same for the same arguments."""
    root = ET.fromstring(xml)
    tool = f"comprope {version}, {root.get('generationTool')}"
    root.attrib.update(guid=guid, **about(interface, version) | {"generationTool": tool})
    _only(root, "CoSimulation").attrib.update(dict.fromkeys(_CAPABILITIES, "true"))
    root.insert(1, unit_definitions(interface.variables))
    root.insert(list(root).index(_only(root, "ModelVariables")), default_experiment(interface))
    for element, variable in zip(_only(root, "ModelVariables"), interface.variables, strict=True):
        element[0].attrib.update(type_attributes(variable))
    _rebuild_structure(_only(root, "ModelStructure"), interface)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def about(interface: ModelInterface, version: str) -> dict[str, str]:
    """Where an FMU comes from and what it is, in attributes that every version of FMI has."""
    return {
        "description": interface.description,
        "author": "comprope",
        "version": version,
        "copyright": "Copyright (c) the comprope authors",
        "license": "MIT; see documentation/licenses",
        "generationTool": f"comprope {version}",
        "generationDateAndTime": FIXED_DATE,
    }


def _only(root: ET.Element, tag: str) -> ET.Element:
    found = root.find(tag)
    if found is None:
        raise ValueError(f"pythonfmu wrote a model description without {tag}")
    return found


def unit_definitions(variables: Iterable[Variable]) -> ET.Element:
    """The units of real variables, each in base units, with those to display them in."""
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
    """Times and step that an importer takes when told nothing else."""
    times = {"startTime": 0.0, "stopTime": interface.stop_time, "stepSize": interface.step_size}
    return ET.Element("DefaultExperiment", {name: repr(value) for name, value in times.items()})


def type_attributes(variable: Variable) -> dict[str, str]:
    """Attributes of the type element: start value, and what a number has besides."""
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
    """List every output twice: as it depends on inputs while stepping, and, at the start, on everything."""
    structure.clear()
    places = {one.name: place for place, one in enumerate(interface.variables, 1)}
    outputs = interface.of_role("output")
    if not outputs:
        return
    while_stepping, at_start = (ET.SubElement(structure, tag) for tag in ("Outputs", "InitialUnknowns"))
    for one in outputs:
        depends_on = " ".join(str(place) for place in sorted(places[name] for name in one.depends_on))
        ET.SubElement(while_stepping, "Unknown", index=str(places[one.name]), dependencies=depends_on)
        ET.SubElement(at_start, "Unknown", index=str(places[one.name]))
