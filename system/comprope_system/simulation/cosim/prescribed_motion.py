"""Prescribed motion of car and counterweight, in place of the drive."""

from collections.abc import Mapping
from typing import Any, Protocol


class EndMotion(Protocol):
    """Motion of one end along one direction, up or outward positive, as numbers or arrays of one number."""

    def position(self, time: float) -> Any:
        """Position [m] at a time [s]."""

    def velocity(self, time: float) -> Any:
        """Velocity [m/s]."""

    def acceleration(self, time: float) -> Any:
        """Acceleration [m/s2]."""


class PrescribedMotion:
    """Participant that outputs position, velocity and acceleration of car and counterweight, and their lateral displacement.

    Its outputs have the names of the drive's, and of the rope's inputs for lateral displacements. It has no inputs.
    """

    def __init__(self, name: str, trips: Mapping[str, EndMotion], lateral: Mapping[str, EndMotion] | None = None) -> None:
        """`trips` and outward displacements of the rope's ends by name: "car" and "counterweight"."""
        self.name = name
        self._trips, self._lateral = dict(trips), dict(lateral or {})
        self._time = 0.0

    def enter_initialization(self, start: float) -> None:
        """See `Participant`."""
        self._time = start

    def set(self, values: Mapping[str, Any]) -> None:
        """See `Participant`."""

    def outputs(self) -> dict[str, Any]:
        """See `Participant`."""
        vertical = {
            f"{what}_{quantity}": float(getattr(trip, quantity)(self._time))
            for what, trip in self._trips.items()
            for quantity in ("position", "velocity", "acceleration")
        }
        sideways = {f"{what}_lateral_displacement": float(trip.position(self._time)) for what, trip in self._lateral.items()}
        return vertical | sideways

    def exit_initialization(self) -> None:
        """See `Participant`."""

    def step(self, time: float, dt: float) -> None:
        """See `Participant`."""
        self._time = time + dt
