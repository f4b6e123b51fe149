"""Plant parameters that every fit adjusts, with the standard deviations of their priors."""

from collections.abc import Mapping
from dataclasses import dataclass

from ..settings import HYPOTHESES


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
