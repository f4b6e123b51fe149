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
from ..compiler.workspace import empty_ends, empty_workspace
from ..integration import input_interpolation
from ..integration.state import empty_state
from ..parameters.parameter_vector import DECLARED, R
from ..runtime.kernel_arguments import Array, RopeData
from ..runtime.status import require_success

ENDS = ("car", "counterweight")
# The inputs by name, in the order of `integration.inputs`.
NAMES = (
    *(f"{end}_position" for end in ENDS),
    *(f"{end}_{rate}" for end in ENDS for rate in ("velocity", "acceleration")),
    *(f"{end}_lateral_displacement" for end in ENDS),
    "base_acceleration",
)


def parabola(times: Array, values: Array, t: float) -> tuple[float, float, float]:
    """Value, slope and curvature at time t of the parabola through three points."""
    function = getattr(input_interpolation.parabola, "py_func", input_interpolation.parabola)
    value, slope, curvature = function(*times, *values, t)
    return value, slope, curvature


class EndMotion:
    """The path of the ends from their inputs; its whole memory is the array `samples` (see `input_interpolation`)."""

    def __init__(self, radius: float, inputs: Mapping[str, Any], time: float, *, derivatives: bool, at_end: bool) -> None:
        p = np.zeros(len(DECLARED))
        p[R] = radius
        self._ends, self._work = empty_ends(), empty_workspace(1, 0, empty_state(0, 0, 0))
        self._ends.options[:] = derivatives, at_end
        self.samples = self._ends.samples
        groups = RopeData(0, 0, 0, p, p), self._ends, self._work
        start, self._check, self._interpolate = (
            compiled()[name].bind(*groups) for name in ("start_inputs", "check_motion", "interpolate_inputs")
        )
        self._read_inputs(inputs)
        start(t=time)

    def _read_inputs(self, inputs: Mapping[str, Any]) -> None:
        self._ends.u[:] = [float(inputs.get(name, 0.0)) for name in NAMES]

    def path(self, time: float, dt: float, inputs: Mapping[str, Any]) -> tuple[Array, float]:
        """The path of the ends to `time + dt` [s], and its duration [s]; they are at its end afterwards.

        The duration is `dt`, with what earlier steps put off; 0 if this step is so short that it is put off as well. Raises
        `InputError` for ends that jump or are too fast.
        """
        self._read_inputs(inputs)
        require_success(self._check(t=time, dt=dt), self._work.message)
        duration = self._interpolate(t=time, dt=dt)
        return self._ends.path.copy(), duration

    @property
    def base(self) -> tuple[float, float]:
        """Acceleration of the building's base [m/s2] at the start and at the end of the last path."""
        return float(self._ends.base[0]), float(self._ends.base[1])

    def to_bytes(self) -> bytes:
        """The whole memory."""
        return self.samples.tobytes()

    def from_bytes(self, data: bytes) -> None:
        """Restore what `to_bytes` gave."""
        self.samples[:] = np.frombuffer(data, np.float64)

    def __len__(self) -> int:
        """Number of bytes that `to_bytes` gives."""
        return self.samples.nbytes
