"""Plant parameters that every fit adjusts, with the standard deviations of their priors."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import log1p
from typing import Literal

from comprope.errors import InputError
from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import values_of

from ...measurements.campaign_file import Tolerance
from ..settings import HYPOTHESES

Tolerances = Mapping[str, Tolerance | Literal["fixed"]]


@dataclass(frozen=True, eq=False)
class Direction:
    """Direction in the space of model parameters, along which one coefficient is fitted.

    `changes` are added to model keys per unit of the coefficient; `prior` is the standard deviation of its normal prior about
    zero, `lower` and `upper` its bounds. A `relative` coefficient is the logarithm of a factor. `origin` says where the prior
    comes from.
    """

    name: str
    changes: Mapping[str, float]
    prior: float
    lower: float = -float("inf")
    upper: float = float("inf")
    relative: bool = False
    origin: str = ""


def _relative(key: str, prior: float, origin: str) -> Direction:
    """Direction of a parameter that is known within a factor of exp(prior)."""
    return Direction(key, {key: 1.0}, prior, *HYPOTHESES.plant_bounds, relative=True, origin=origin)


CLOCK = "clock.offset"
USER = "stated in campaign.toml"
PLANT_PARAMETERS = (
    _relative("rope.bending_stiffness", 0.15, "engineering judgement: the stiffness of a stranded rope depends on its use"),
    _relative("rope.bending_damping", 0.4, "engineering judgement: hardly ever stated"),
    _relative("rope.mass_per_length", 0.1, "engineering judgement: data sheets differ from the rope as delivered and greased"),
    _relative("rope.axial_stiffness", 0.1, "engineering judgement"),
    _relative("contact.friction_coefficient", 0.3, "engineering judgement: 0.05 to 0.2 bare, 0.3 lined"),
    _relative("contact.stiffness", 0.4, "engineering judgement: hardly ever stated"),
    _relative("sheave.mass", 0.01, "engineering judgement: weighed"),
    _relative("sheave.inertia", 0.02, "engineering judgement: from drawings"),
    _relative("shaft.pit", 0.004, "engineering judgement: measured with a tape"),
    Direction(
        "rope.external_damping", {"rope.external_damping": 1.0}, 0.01, 0.0, 1.0, origin="engineering judgement: none is usual"
    ),
    # Delay of all channels against the car's position [s]: drive log and sensors may have different clocks.
    Direction(CLOCK, {}, 0.02, -0.5, 0.5, origin="engineering judgement: one or two samples of a logger"),
)


def plant_values(model: Base) -> dict[str, float]:
    """Values of the parameters of a model by key, with the clock's."""
    return values_of(model) | {CLOCK: 0.0}


def with_tolerances(stated: Tolerances, values: Mapping[str, float]) -> tuple[Direction, ...]:
    """The plant parameters with the priors that a user states; `values` are those of the model file by key.

    Fixed parameters keep their prior here and are held by the fits. Raises `InputError` with one line for each tolerance that is
    none.
    """
    problems = [line for key, one in stated.items() for line in _tolerance_problems(key, one, values)]
    if problems:
        raise InputError("\n".join(problems))
    return tuple(_with_tolerance(one, stated.get(one.name), values) for one in PLANT_PARAMETERS)


def fixed_parameters(stated: Tolerances) -> frozenset[str]:
    """The parameters that a user calls fixed."""
    return frozenset(key for key, one in stated.items() if one == "fixed")


def _tolerance_problems(key: str, one: Tolerance | str, values: Mapping[str, float]) -> list[str]:
    known = {direction.name: direction for direction in PLANT_PARAMETERS}
    if key not in known:
        return [f'plant."{key}": no parameter that fits adjust; accepted are {", ".join(known)}']
    if isinstance(one, Tolerance):
        if (one.relative is None) == (one.absolute is None):
            return [f'plant."{key}": either relative or absolute is accepted, or "fixed"']
        if one.relative is not None and not known[key].relative:
            return [f'plant."{key}": relative = {one.relative:g}: for this parameter absolute is accepted']
        if one.absolute is not None and known[key].relative and not values[key] > 0.0:
            return [f'plant."{key}": absolute = {one.absolute:g}: the model file has {values[key]:g}, which no factor changes']
    return []


def _with_tolerance(one: Direction, stated: Tolerance | str | None, values: Mapping[str, float]) -> Direction:
    if not isinstance(stated, Tolerance):
        return one
    if stated.absolute is not None:
        prior = log1p(stated.absolute / values[one.name]) if one.relative else stated.absolute
    else:
        prior = log1p(stated.relative or 0.0)
    return replace(one, prior=prior, origin=USER)
