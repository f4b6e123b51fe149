"""Parameters of a rope model, each declared once, and the flat vector in which the kernels read them."""

from .building import Building
from .components import DEFAULT_STEP, Base, Contact, Rope, Sensor, Shaft, Sheave, Solver

__all__ = ["DEFAULT_STEP", "Base", "Building", "Contact", "Rope", "Sensor", "Shaft", "Sheave", "Solver"]
