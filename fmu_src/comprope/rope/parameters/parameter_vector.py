"""The flat parameter vector that the kernels read: one slot for each declared quantity.

Slots are compile-time constants in the kernels. Base components come first, then effects in the
order in which they register. Derived are `element`, since the mesh makes the natural length exact, one rope's share of the
sheave's mass and inertia, with which the kernels compute, and the motion of the building's base and walls, which is zero
outside of the time steps.
"""

from collections.abc import Mapping
from dataclasses import replace

from ...errors import InputError
from ...quantities import Component, Quantity, quantities
from ...validation_messages import suggestion
from .components import Contact, Rope, Shaft, Sheave, Solver

COMPONENTS: dict[str, type[Component]] = {"shaft": Shaft, "rope": Rope, "sheave": Sheave, "contact": Contact, "solver": Solver}

DECLARED: dict[str, Quantity] = {}


def declare(prefix: str, component: type[Component]) -> None:
    """Give every quantity of `component` a slot, named `prefix.quantity`."""
    DECLARED.update({f"{prefix}.{one.name}": one for one in quantities(component)})


for _prefix, _component in COMPONENTS.items():
    declare(_prefix, _component)
DECLARED["derived.element"] = Quantity("element", "m", "exact element length", 0.0, 10.0, 0.05, 0.05, None)
for _name in ("mass", "inertia"):
    _whole = DECLARED[f"sheave.{_name}"]
    DECLARED[f"derived.{_name}_per_rope"] = replace(_whole, name=f"{_name}_per_rope", help=f"one rope's share of the {_name}")
for _name, _when in (("acceleration", "at the end of a time step"), ("acceleration_before", "at its start")):
    DECLARED[f"derived.base_{_name}"] = Quantity(
        f"base_{_name}", "m/s2", f"acceleration of the building's base {_when}", -100.0, 100.0, 0.0, 1.0, None
    )
for _end in ("car", "counterweight"):
    for _unit, _what in (("m", "displacement"), ("m/s", "velocity")):
        _name = f"{_end}_wall_{_what}"
        _help = f"{_what} of the walls at the height of the {_end}'s end, towards the counterweight's side"
        DECLARED[f"derived.{_name}"] = Quantity(_name, _unit, _help, -100.0, 100.0, 0.0, 1.0, None)


def slot(name: str) -> int:
    """Index of a quantity in the parameter vector; raises `InputError` for one that is not declared."""
    if name not in DECLARED:
        raise InputError(f"{name}: no such quantity; {suggestion(name, list(DECLARED))}")
    return list(DECLARED).index(name)


def vector(values: Mapping[str, float]) -> list[float]:
    """Parameter vector from values by name; what is not named takes its neutral value."""
    return [float(values.get(name, one.neutral)) for name, one in DECLARED.items()]


G = slot("shaft.gravity")
RHO = slot("rope.mass_per_length")
DIAMETER = slot("rope.diameter")
EA = slot("rope.axial_stiffness")
EI = slot("rope.bending_stiffness")
CA = slot("rope.axial_damping")
CB = slot("rope.bending_damping")
CE = slot("rope.external_damping")
RATIO = slot("rope.compression_ratio")
M = slot("derived.mass_per_rope")
R = slot("sheave.radius")
J = slot("derived.inertia_per_rope")
K = slot("contact.stiffness")
C = slot("contact.damping")
MU = slot("contact.friction_coefficient")
V0 = slot("contact.slip_velocity")
ALPHA = slot("solver.numerical_damping")
SWITCH = slot("sheave.limit_switch")
PIT = slot("shaft.pit")
HEIGHT = slot("shaft.height")
ELEMENT = slot("derived.element")
BASE = slot("derived.base_acceleration")
BASE_BEFORE = slot("derived.base_acceleration_before")
WALLS_FOLLOW = slot("shaft.walls_follow")
CAR_WALL = slot("derived.car_wall_displacement")
CAR_WALL_V = slot("derived.car_wall_velocity")
COUNTERWEIGHT_WALL = slot("derived.counterweight_wall_displacement")
COUNTERWEIGHT_WALL_V = slot("derived.counterweight_wall_velocity")
