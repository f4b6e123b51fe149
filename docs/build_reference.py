"""Write `reference.md`, beside this file, from the declarations: `python docs/build_reference.py`."""

import runpy
import sys
from collections.abc import Iterable
from pathlib import Path

from pydantic import BaseModel

from comprope.drive.cosimulation import interface as drive_interface
from comprope.drive.parameters import Drive
from comprope.fmi.model_interface import ModelInterface
from comprope.quantities import Quantity, quantities
from comprope.rope.effects import INSTRUMENT, REGISTRY
from comprope.rope.model_file import load
from comprope.rope.parameters import Building, Sensor
from comprope.rope.parameters.parameter_vector import COMPONENTS, DECLARED
from comprope.rope.simulator.cosimulation import interface as rope_interface
from comprope_system.identification.data.campaign import CampaignFile, Channel, RunSpec
from comprope_system.identification.prediction.plant_parameters import PLANT_PARAMETERS
from comprope_system.identification.settings import GROUPS, settings_of
from comprope_system.measurements.units import UNITS
from comprope_system.presets import model_path
from comprope_system.simulation.trips.result_columns import columns

PATH = Path(__file__).with_name("reference.md")
TITLE = """# Reference

All keys, parameters, variables and columns with their meaning, unit and accepted range. This page is generated from the
declarations in the program by `python docs/build_reference.py`; do not edit it.
"""
# Symbols of the paper, as used in the kernels, and their quantity or FMU variable.
SYMBOLS = {
    "rho": "rope.mass_per_length", "EA": "rope.axial_stiffness", "EI": "rope.bending_stiffness", "c_A": "rope.axial_damping",
    "c_B": "rope.bending_damping", "c_E": "rope.external_damping", "d": "rope.diameter", "l": "rope.element_length",
    "M": "sheave.mass", "R": "sheave.radius", "J": "sheave.inertia", "k": "contact.stiffness", "c": "contact.damping",
    "mu": "contact.friction_coefficient", "v_0": "contact.slip_velocity", "g": "shaft.gravity", "H": "shaft.height",
    "alpha": "solver.numerical_damping", "h": "solver.step",
}  # fmt: skip
VARIABLES = {  # state variables: symbol, sign between the equations and the FMU, output
    "x_s": "pit - sheave_displacement", "theta": "sheave_angle", "omega": "sheave_angular_velocity", "P_x": "sheave_force",
}  # fmt: skip


def text() -> str:
    """Text of the page."""
    rope, drive = rope_interface(load(model_path("tower50"))), drive_interface()
    parts = [
        TITLE, _symbols(rope), _model_file(), _effects(), _campaign(), _columns(),
        _fmu("The rope's FMU", rope), _fmu("The drive's FMU", drive), _drive(), _api(), _plant_priors(),
        _settings(),
    ]  # fmt: skip
    return "\n".join(parts)


def _api() -> str:
    return str(runpy.run_path(str(PATH.with_name("api_reference.py")))["text"](_table))


def _symbols(rope: ModelInterface) -> str:
    declared = [
        (f"`{symbol}`", f"{key.partition('.')[0]}: {DECLARED[key].help}", DECLARED[key].unit, f"`{key}`")
        for symbol, key in SYMBOLS.items()
    ]
    outputs = {one.name: one for one in rope.of_role("output")}
    states = [
        (f"`{symbol}`", outputs[name.split(" - ")[-1]].help, outputs[name.split(" - ")[-1]].unit, f"`{name}`")
        for symbol, name in VARIABLES.items()
    ]
    return _section(
        "Nomenclature", "Symbols of [theory.md](theory.md) and of the kernels.", ("", "", "unit", "name"), declared + states
    )


def _model_file() -> str:
    introduction = "Tables of a model file. Without a default a quantity must be given. FMU parameters have the same names."
    tables = [_quantities(f"`[{name}]`", component) for name, component in COMPONENTS.items()]
    others = (_fields("`[[sensors]]`", Sensor, 3), _fields("`[building]`", Building, 3))
    return "\n".join([f"## Model file\n\n{introduction}\n", *tables, *others])


def _effects() -> str:
    introduction = (
        "Each is a table `[effects.NAME]` of a model file. An effect without a table is not part of the model. Formulas and "
        "sources: [theory.md](theory.md). Effects of your own: [own_effect.md](own_effect.md)."
    )
    tables = [_quantities(f"`[effects.{name}]`", effect) for name, effect in REGISTRY.items() if not effect.source]
    instruments = _table(("instrument", ""), [(f"`[effects.{name}]`", help) for name, help in INSTRUMENT.items()])
    return "\n".join([f"## Effects\n\n{introduction}\n", *tables, "### Instruments\n", instruments])


def _campaign() -> str:
    units = _table(
        ("quantity", "units"), [(f"`{name}`", ", ".join(f"`{unit}`" for unit in known)) for name, known in UNITS.items()]
    )
    tables = (
        _fields("top of the file", CampaignFile, 3),
        _fields("`[[channels]]`", Channel, 3),
        _fields("`[[runs]]`", RunSpec, 3),
    )
    return "\n".join(["## Campaign: `campaign.toml`\n", *tables, "### Quantities of channels\n", units])


def _columns() -> str:
    rows = [("`time`", "s", "from the start of the simulation")]
    rows += [(f"`{one.name}`", one.unit, one.help) for one in columns(("NAME",), driven=True, moving=True)]
    introduction = "What `comprope simulate --out FILE.csv` writes; `NAME` stands for each sensor's name."
    return _section("Columns of a simulated trip", introduction, ("column", "unit", ""), rows)


def _drive() -> str:
    tables = [_quantities(f"`[{name}]`", type(getattr(Drive(), name))) for name in Drive.model_fields if name != "curve"]
    introduction = (
        "Tables of a drive file, `comprope simulate --drive FILE.toml`, and parameters of the drive's FMU. `[curve]` has `a1` to "
        "`a19`: accelerations at twentieths of the travel time, over the largest, for trips of a free shape."
    )
    return "\n".join([f"## Drive file\n\n{introduction}\n", *tables])


def _plant_priors() -> str:
    intro = (
        "Plant parameters that every fit of the identification adjusts, with the standard deviation of the prior: of the "
        "parameter's logarithm where it is relative, else in the unit of the parameter."
    )
    rows = [
        (
            f"`{one.name}`",
            f"{one.prior:g}",
            "relative" if one.relative else "absolute",
            f"{one.lower:g} … {one.upper:g}",
            one.origin,
        )
        for one in PLANT_PARAMETERS
    ]
    return _section("Plant parameters and their priors", intro, ("parameter", "prior", "", "bounds", "origin"), rows)


def _settings() -> str:
    intro = (
        "Constants of comparison, diagnosis and model updating, in `comprope_system.identification.settings`: what each decides "
        "and where its value comes from. They are part of the method and not meant to be set for a campaign."
    )
    tables = [
        f"### {type(group).__name__}\n\n{_summary(type(group))}"
        + _table(
            ("constant", "value", "unit", "decides", "origin"),
            [(f"`{one.name}`", _shown(one.value), "" if one.unit == "1" else one.unit, one.decides, one.origin)
             for one in settings_of(group)],
        )
        for group in GROUPS
    ]  # fmt: skip
    return "\n".join([f"## Constants of the identification\n\n{intro}\n", *tables])


def _shown(value: object) -> str:
    return ", ".join(f"{one:g}" for one in value) if isinstance(value, tuple) else f"{value:g}"


def _fmu(title: str, interface: ModelInterface) -> str:
    introduction = f"`{interface.name}.fmu`. {interface.description}."
    rows = [
        (f"`{one.name}`", role, one.kind, one.unit if one.kind == "real" else "", one.help)
        for role in ("input", "output")
        for one in interface.of_role(role)
        if "[" not in one.name or "[1]" in one.name
    ]
    switches = [
        (f"`{one.name}`", "parameter", one.kind, "", one.help) for one in interface.of_role("parameter") if "." not in one.name
    ]
    return _section(title, introduction, ("variable", "role", "type", "unit", ""), rows + switches)


def _quantities(title: str, component: type[BaseModel]) -> str:
    rows = [(f"`{one.name}`", one.unit, _range(one), _default(one), one.help) for one in quantities(component)]
    return f"### {title}\n\n{_summary(component)}{_table(('key', 'unit', 'accepted', 'default', ''), rows)}"


def _summary(component: type[BaseModel]) -> str:
    return f"{(component.__doc__ or '').strip().splitlines()[0]}\n\n"


def _range(one: Quantity) -> str:
    return f"{one.minimum:g} … {one.maximum:g}"


def _default(one: Quantity) -> str:
    return "" if one.default is None else f"{one.default:g}"


def _fields(title: str, component: type[BaseModel], level: int) -> str:
    rows = [
        (f"`{field.alias or name}`", "required" if field.is_required() else "", field.description or "")
        for name, field in component.model_fields.items()
    ]
    return f"{'#' * level} {title}\n\n{_summary(component)}{_table(('key', '', ''), rows)}"


def _section(title: str, introduction: str, head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    return f"## {title}\n\n{introduction}\n\n{_table(head, rows)}"


def _table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    titles = list(head)
    lines = [titles, ["---"] * len(titles), *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


if __name__ == "__main__":
    PATH.write_text(text(), encoding="utf-8")
    sys.stdout.write(f"{PATH}\n")
