"""Parameters of an elevator drive, each declared once, and the checks of those that belong together."""

from .components import CompensationRopes, Curve, Drive, FirstTrip, Plant, Profile, Servo, Shaft, Shaper
from .parameter_checks import INTERVALS, SHORTEST_SMOOTHING

__all__ = [
    "INTERVALS", "SHORTEST_SMOOTHING", "CompensationRopes", "Curve", "Drive", "FirstTrip", "Plant", "Profile", "Servo",
    "Shaft", "Shaper",
]  # fmt: skip
