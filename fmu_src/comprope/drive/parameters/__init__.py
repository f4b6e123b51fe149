"""Parameters of an elevator drive, each declared once, and the checks of those that belong together."""

from .components import (
    Brake,
    Buffer,
    CompensationRopes,
    Curve,
    Drive,
    FirstTrip,
    Plant,
    Profile,
    SafetyGear,
    Servo,
    Shaft,
    Shaper,
    Traction,
)
from .parameter_checks import INTERVALS, SHORTEST_SMOOTHING

__all__ = [
    "INTERVALS", "SHORTEST_SMOOTHING", "Brake", "Buffer", "CompensationRopes", "Curve", "Drive", "FirstTrip", "Plant", "Profile",
    "SafetyGear", "Servo", "Shaft", "Shaper", "Traction",
]  # fmt: skip
