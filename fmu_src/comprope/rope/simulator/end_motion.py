"""Smooth paths of the rope's ends within a communication step, interpolated from input samples.

Positions arrive once per communication step. With velocities and accelerations beside them the state
of the end at the close of the step is known, or extrapolated if the sample belongs to its start;
without them it is read off the parabola through the last three samples. A quintic leads there from
where the end is, so ends never jump, whatever the communication step.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..compiler.entry_points import compiled
from ..compiler.workspace import empty_ends
from ..integration import input_interpolation
from ..runtime.kernel_arguments import Array, RopeData
from ..runtime.parameter_vector import DECLARED, R

ENDS = ("car", "counterweight")
# The inputs by name, in the order of `integration.inputs`.
NAMES = (
    *(f"{end}_position" for end in ENDS),
    *(f"{end}_{rate}" for end in ENDS for rate in ("velocity", "acceleration")),
    *(f"{end}_lateral_displacement" for end in ENDS),
)


def parabola(times: Array, values: Array, t: float) -> tuple[float, float, float]:
    """Value, slope and curvature at time t of the parabola through three points."""
    value, slope, curvature = getattr(input_interpolation.parabola, "py_func", input_interpolation.parabola)(times, values, 0, t)
    return value, slope, curvature


class EndMotion:
    """The path of the ends from their inputs; its whole memory is the array `samples` (see `input_interpolation`)."""

    def __init__(self, radius: float, inputs: Mapping[str, Any], time: float, *, derivatives: bool, at_end: bool) -> None:
        p = np.zeros(len(DECLARED))
        p[R] = radius
        self._ends = empty_ends()
        self._ends.options[:] = derivatives, at_end
        self.samples = self._ends.samples
        start, self._interpolate = (
            compiled()[name].bind(RopeData(0, 0, 0, p, p), self._ends) for name in ("start_inputs", "interpolate_inputs")
        )
        self._read_inputs(inputs)
        start(t=time)

    def _read_inputs(self, inputs: Mapping[str, Any]) -> None:
        self._ends.u[:] = [float(inputs.get(name, 0.0)) for name in NAMES]

    def path(self, time: float, dt: float, inputs: Mapping[str, Any]) -> Array:
        """The path of the ends from `time` to `time + dt` [s]; they are at its end afterwards."""
        self._read_inputs(inputs)
        self._interpolate(t=time, dt=dt)
        return self._ends.path.copy()

    def to_bytes(self) -> bytes:
        """The whole memory."""
        return self.samples.tobytes()

    def from_bytes(self, data: bytes) -> None:
        """Restore what `to_bytes` gave."""
        self.samples[:] = np.frombuffer(data, np.float64)

    def __len__(self) -> int:
        """Number of bytes that `to_bytes` gives."""
        return self.samples.nbytes
