"""Trips of the car: the smooth motion behind a noisy position signal."""

from .recover import recover_trip
from .trip import Trip

__all__ = ["Trip", "recover_trip"]
