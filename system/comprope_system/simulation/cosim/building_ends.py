"""The building as a participant: it moves the rope's ends sideways, and accelerates their frame."""

from collections.abc import Mapping
from typing import Any

from ..building_motion.motion import BuildingMotion

POSITIONS = ("car_position", "counterweight_position")
OUTPUTS = ("car_lateral_displacement", "counterweight_lateral_displacement", "base_acceleration")


class BuildingEnds:
    """Participant with the positions of car and counterweight as inputs, and the rope's inputs of the building as outputs."""

    def __init__(self, name: str, motion: BuildingMotion) -> None:
        self.name = name
        self._motion, self._time = motion, 0.0
        self._heights = dict.fromkeys(POSITIONS, 0.0)

    def enter_initialization(self, start: float) -> None:
        """See `Participant`."""
        self._time = start

    def set(self, values: Mapping[str, Any]) -> None:
        """See `Participant`."""
        self._heights |= {name: float(value) for name, value in values.items()}

    def outputs(self) -> dict[str, Any]:
        """Outward displacements [m], and acceleration [m/s2] towards the counterweight's side."""
        car, counterweight = (self._motion.displacement(self._heights[one], self._time) for one in POSITIONS)
        return dict(zip(OUTPUTS, (-car, counterweight, self._motion.base_acceleration(self._time)), strict=True))

    def exit_initialization(self) -> None:
        """See `Participant`."""

    def step(self, time: float, dt: float) -> None:
        """See `Participant`."""
        self._time = time + dt
