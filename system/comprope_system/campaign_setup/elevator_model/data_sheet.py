"""A rope model from a data sheet: a model file that names the rope's construction and leaves out what follows from it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from comprope.errors import InputError
from comprope.quantities import Component, quantities
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table, load, validated
from comprope.rope.parameters import Contact, Rope, Sheave

from ...presets import model_path
from .rope_catalogue import ACCEPTED, Estimate, catalogue_rope

DEFAULTS = "tower50"  # the model whose contact is taken
INERTIA = 0.5  # over mass and square of the radius: a solid disc
INERTIA_TOLERANCE = 0.3  # a rim has more, a frame and weights that do not turn have less
KEY = "construction"
COMPONENTS: dict[str, type[Component]] = {"rope": Rope, "sheave": Sheave, "contact": Contact}


@dataclass(frozen=True)
class EstimatedModel:
    """A model, and the estimates by key of the model file that no data sheet states."""

    model: RopeModel
    estimates: Mapping[str, Estimate] = field(default_factory=dict)

    @property
    def tolerances(self) -> dict[str, float]:
        """Relative standard deviations of the estimates that fits adjust, by key: the table `[plant]` of campaign.toml."""
        return {key: one.tolerance for key, one in self.estimates.items() if one.tolerance is not None}

    @property
    def sentences(self) -> list[str]:
        """What each estimate is, how well it is known, and why."""
        return [
            f"{key} = {one.value:.4g}{_unit(key)}, estimated{_within(one)}: {one.origin}" for key, one in self.estimates.items()
        ]


def _unit(key: str) -> str:
    section, _, name = key.partition(".")
    unit = next(one.unit for one in quantities(COMPONENTS[section]) if one.name == name)
    return "" if unit == "1" else f" {unit}"


def _within(estimate: Estimate) -> str:
    if estimate.tolerance is None:
        return ""
    if estimate.tolerance < 1.0:
        return f" within {100.0 * estimate.tolerance:g} %"
    return f" within a factor of {1.0 + estimate.tolerance:g}"


def is_data_sheet(table: Mapping[str, Any]) -> bool:
    """Whether the tables of a TOML file are a data sheet: its rope has a construction."""
    return isinstance(table.get("rope"), dict) and KEY in table["rope"]


def from_data_sheet(table: Mapping[str, Any], source: str) -> EstimatedModel:
    """The model of a data sheet; what it states goes before the estimates.

    It is a model file with `construction` in `[rope]` in place of mass, stiffness and damping, `diameter` in place of `radius` in
    `[sheave]` if wished, and without `[contact]` or the sheave's inertia if these are not known. Raises `InputError` with one
    line for each problem, each beginning with `source`.
    """
    problems: list[str] = []
    rope, sheave = dict(table["rope"]), table.get("sheave")
    estimates = {f"rope.{key}": one for key, one in _rope(rope, problems).items() if key not in rope}
    sheave = dict(sheave) if isinstance(sheave, dict) else sheave
    if isinstance(sheave, dict):
        _use_diameter(sheave, problems)
        estimates |= _inertia(sheave)
    preset = as_table(load(model_path(DEFAULTS)))
    contact = table.get("contact", {})
    if isinstance(contact, dict):
        assumed = {
            key: Estimate(value, None, "the test tower's") for key, value in preset["contact"].items() if key not in contact
        }
        estimates |= {f"contact.{key}": one for key, one in assumed.items()}
    filled: dict[str, Any] = {**table, "rope": rope, "contact": contact} | ({} if sheave is None else {"sheave": sheave})
    for key, one in estimates.items():
        section, _, name = key.partition(".")
        filled[section] = {**filled[section], name: one.value}
    try:
        # A rope whose construction is not known has the preset's values here, so that all other problems are told too.
        model = validated(filled if not problems else filled | {"rope": {**preset["rope"], **rope}}, source)
    except InputError as error:
        problems += [line.removeprefix(f"{source}: ") for line in str(error).splitlines()]
    if problems:
        raise InputError("\n".join(f"{source}: {line}" for line in problems))
    return EstimatedModel(model, estimates)


def _rope(rope: dict[str, Any], problems: list[str]) -> dict[str, Estimate]:
    """The estimates of a rope, whose construction is taken out of its table; none, with a problem, where there are none."""
    construction, diameter = rope.pop(KEY), rope.get("diameter")
    if not isinstance(construction, str):
        problems.append(f"rope.{KEY} = {construction}: {ACCEPTED}")
        return {}
    limits = next(one for one in quantities(Rope) if one.name == "diameter")
    known = diameter if isinstance(diameter, int | float) and limits.minimum <= diameter <= limits.maximum else limits.nominal
    try:
        return catalogue_rope(float(known), construction)
    except InputError as error:
        problems.append(f"rope.{KEY} = {error}")
        return {}


def _use_diameter(sheave: dict[str, Any], problems: list[str]) -> None:
    """Replace the diameter of a sheave by its radius."""
    if "diameter" not in sheave:
        return
    diameter = sheave.pop("diameter")
    if "radius" in sheave:
        problems.append(f"sheave.diameter = {diameter}: either diameter or radius is accepted")
    elif not isinstance(diameter, int | float) or isinstance(diameter, bool):
        problems.append(f"sheave.diameter = {diameter}: a number of metres to the rope's centre line on either side is accepted")
        sheave["radius"] = INERTIA  # any that is accepted
    else:
        sheave["radius"] = 0.5 * diameter


def _inertia(sheave: dict[str, Any]) -> dict[str, Estimate]:
    """The inertia of a sheave, if its data sheet leaves it out."""
    mass, radius = sheave.get("mass"), sheave.get("radius")
    if "inertia" in sheave or not isinstance(mass, int | float) or not isinstance(radius, int | float):
        return {}
    value = float(f"{INERTIA * mass * radius**2:.4g}")
    return {"sheave.inertia": Estimate(value, INERTIA_TOLERANCE, "a solid disc of the sheave's mass")}
