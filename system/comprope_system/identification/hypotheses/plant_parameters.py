"""Plant parameters with the standard deviations of their priors."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, eq=False)
class Direction:
    """One coefficient: `changes` of the model when it is 1, its prior standard deviation and bounds.

    A `relative` one is the logarithm of a factor.
    """

    name: str
    changes: Mapping[str, float]
    prior: float
    lower: float = -float("inf")
    upper: float = float("inf")
    relative: bool = False


def _plant(key: str, prior: float) -> Direction:
    return Direction(key, {key: 1.0}, prior, -2.3, 1.4, relative=True)


CLOCK = "clock.offset"
# How well a plant's data sheet is usually known: relative standard deviations.
PLANT_PARAMETERS = (
    _plant("rope.bending_stiffness", 0.15),
    _plant("rope.bending_damping", 0.4),
    _plant("rope.mass_per_length", 0.1),
    _plant("rope.axial_stiffness", 0.1),
    _plant("contact.friction_coefficient", 0.3),
    _plant("contact.stiffness", 0.4),
    _plant("sheave.mass", 0.01),
    _plant("sheave.inertia", 0.02),
    _plant("shaft.pit", 0.004),
    Direction("rope.external_damping", {"rope.external_damping": 1.0}, 0.01, 0.0, 1.0),
    # How late all channels are against the car's position [s]: drive log and sensors may have clocks of their own.
    Direction(CLOCK, {}, 0.02, -0.5, 0.5),
)
