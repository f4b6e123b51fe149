"""Measured runs: files of any logger, columns and units, and the motion of car and counterweight."""

from .motion.recover import recover_trip
from .motion.trip import Trip

__all__ = ["Trip", "recover_trip"]
