"""From input samples to the smooth way of the rope's ends within a communication step.

Positions arrive once per communication step. With velocities and accelerations beside them the state
of the end at the close of the step is known, or extrapolated if the sample belongs to its start;
without them it is read off the parabola through the last three samples. A quintic leads there from
where the end is, so ends never jump, whatever the communication step.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..compiler.entry_points import compiled
from ..integration import input_interpolation
from ..integration.input_interpolation import PAST
from ..integration.inputs import INPUTS
from ..integration.state import Array
from ..mechanics.end_conditions import PATH, PATHS
from ..runtime.parameter_vector import DECLARED, R

ENDS = ("car", "counterweight")
# The inputs by name, as the kernels count them (see `standing`).
NAMES = (
    *(f"{end}_position" for end in ENDS),
    *(f"{end}_{rate}" for end in ENDS for rate in ("velocity", "acceleration")),
    *(f"{end}_lateral_displacement" for end in ENDS),
)


def parabola(times: Array, values: Array, at: float) -> tuple[float, float, float]:
    """Value, slope and curvature at `at` of the parabola through three points."""
    value, slope, curvature = getattr(input_interpolation.parabola, "py_func", input_interpolation.parabola)(times, values, 0, at)
    return value, slope, curvature


class EndMotion:
    """Where the ends are and have been told to be; its whole memory is the array `past` (see `following`)."""

    def __init__(self, radius: float, inputs: Mapping[str, Any], time: float, *, derivatives: bool, at_end: bool) -> None:
        p = np.zeros(len(DECLARED))
        p[R] = radius
        self._u, self.past, self._path = np.zeros(INPUTS), np.zeros(PAST), np.zeros(PATHS * PATH)
        arrays = {"p": p, "u": self._u, "past": self.past, "path": self._path, "options": np.array([derivatives, at_end], float)}
        begin, lead = (compiled()[name] for name in ("begin_motion", "lead"))
        self._lead = lead.bind(**{name: array for name, array in arrays.items() if name in lead.names})
        self._hear(inputs)
        begin.bind(**{name: array for name, array in arrays.items() if name in begin.names})(t=time)

    def _hear(self, inputs: Mapping[str, Any]) -> None:
        self._u[:] = [float(inputs.get(name, 0.0)) for name in NAMES]

    def path(self, time: float, dt: float, inputs: Mapping[str, Any]) -> Array:
        """The way of the ends from `time` to `time + dt` [s]; they stand at its end afterwards."""
        self._hear(inputs)
        self._lead(t=time, dt=dt)
        return self._path.copy()

    def to_bytes(self) -> bytes:
        """The whole memory."""
        return self.past.tobytes()

    def from_bytes(self, data: bytes) -> None:
        """Restore what `to_bytes` gave."""
        self.past[:] = np.frombuffer(data, np.float64)

    def __len__(self) -> int:
        """Number of bytes that `to_bytes` gives."""
        return self.past.nbytes
