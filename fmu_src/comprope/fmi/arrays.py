"""Arrays of FMI 3.0: variables whose names differ in an index alone, as `sensors[1].height` and `sensors[2].height`."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from ..errors import InputError
from .model_interface import ModelInterface, Variable

_INDEX = re.compile(r"\[(\d+)\]")


@dataclass(frozen=True)
class Group:
    """Variables that are one variable of FMI 3.0: a scalar, or an array with a fixed number of elements, one perhaps.

    The first stands at `place` among the variables of the model, the others follow it every `stride`. `place` is the value
    reference.
    """

    elements: tuple[Variable, ...]
    place: int
    stride: int = 1
    is_array: bool = False

    @cached_property
    def variable(self) -> Variable:
        """The group as one variable; of an array it has all attributes but the start values."""
        first = self.elements[0]
        return replace(first, name=array_name(first.name), help=first.array) if self.is_array else first


def array_name(name: str) -> str:
    """The name of the array that an element belongs to: `sensors.height` for `sensors[1].height`."""
    return _INDEX.sub("", name)


def groups_of(interface: ModelInterface) -> tuple[Group, ...]:
    """The variables of FMI 3.0 in the order of their first elements.

    Raises `InputError` for an array whose elements differ in more than their description and start value, or do not stand at
    equal distances.
    """
    found: dict[str, list[int]] = {}
    for place, one in enumerate(interface.variables):
        found.setdefault(array_name(one.name) if one.array else one.name, []).append(place)
    return tuple(_group(name, places, interface.variables) for name, places in found.items())


def _group(name: str, places: list[int], variables: tuple[Variable, ...]) -> Group:
    elements = tuple(variables[place] for place in places)
    stride = places[1] - places[0] if len(places) > 1 else 1
    alike = {replace(one, name="", help="", start=None) for one in elements}
    indices = [_INDEX.findall(one.name) for one in elements]
    if elements[0].array and indices != [[str(k)] for k in range(1, len(elements) + 1)]:
        raise InputError(f"{name}: the elements of an array are numbered from 1")
    if len(alike) > 1 or places != list(range(places[0], places[-1] + 1, stride)):
        raise InputError(f"{name}: elements of an array are alike, at equal distances; these are not")
    return Group(elements, places[0], stride, bool(elements[0].array))


def places_of(groups: tuple[Group, ...]) -> Mapping[str, int]:
    """The value reference in FMI 3.0 of each variable of the model: that of the array for its elements."""
    return {one.name: group.place for group in groups for one in group.elements}
