"""From input samples to the smooth way of the rope's ends within a communication step.

Positions arrive once per communication step. With velocities and accelerations beside them the state
of the end at the close of the step is known, or extrapolated if the sample belongs to its start;
without them it is read off the parabola through the last three samples. A quintic leads there from
where the end is, so ends never jump, whatever the communication step.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from .ends import PATH, PATHS
from .state import Array

SAMPLES = 3
POSITIONS = ("car_position", "car_lateral_displacement", "counterweight_position", "counterweight_lateral_displacement")
DERIVATIVES = (("car_velocity", "car_acceleration"), None, ("counterweight_velocity", "counterweight_acceleration"), None)


def parabola(times: Array, values: Array, at: float) -> tuple[float, float, float]:
    """Value, slope and curvature at `at` of the parabola through three points, by Newton's divided differences."""
    (t0, t1, t2), (x0, x1, x2) = times, values
    first, second = (x1 - x0) / (t1 - t0), (x2 - x1) / (t2 - t1)
    bow = (second - first) / (t2 - t0)
    value = x2 + (at - t2) * (second + (at - t1) * bow)
    return value, second + bow * (2.0 * at - t1 - t2), 2.0 * bow


class EndMotion:
    """Where the ends are and have been told to be; its whole memory is the array `memory`.

    signs and offsets turn inputs (heights, outward displacements) into x (down) and y.
    """

    def __init__(self, radius: float, inputs: Mapping[str, Any], time: float, *, derivatives: bool, at_end: bool) -> None:
        self.signs = np.array([-1.0, -1.0, -1.0, 1.0])
        self.offsets = np.array([0.0, -radius, 0.0, radius])
        self.derivatives = derivatives
        self.at_end = at_end
        start = self._sample(inputs)
        # Rest before the start: three equal samples a second apart, and an end without velocity.
        self.times = np.array([time - 2.0, time - 1.0, time])
        self.samples = np.repeat(start[:, None], SAMPLES, axis=1)
        self.reached = np.zeros((PATHS, 3))
        self.reached[:, 0] = start

    def _sample(self, inputs: Mapping[str, Any]) -> Array:
        return self.signs * np.array([float(inputs[name]) for name in POSITIONS]) + self.offsets

    def path(self, time: float, dt: float, inputs: Mapping[str, Any]) -> Array:
        """The way of the ends from `time` to `time + dt` [s]; they stand at its end afterwards."""
        self._remember(time + dt if self.at_end else time, self._sample(inputs))
        target = np.array([self._target(k, time + dt, inputs) for k in range(PATHS)])
        path = np.concatenate([self.reached, target], axis=1).ravel()
        self.reached = target
        return path

    def _remember(self, time: float, sample: Array) -> None:
        if time > self.times[-1]:
            still = np.array_equal(self.samples, np.repeat(self.samples[:, :1], SAMPLES, axis=1))
            step = time - self.times[-1]
            # While nothing has moved, rest is assumed up to the last sample.
            self.times = np.array([time - 2.0 * step, time - step, time]) if still else np.append(self.times[1:], time)
            self.samples = np.column_stack([self.samples[:, 1:], sample])
        else:
            self.samples[:, -1] = sample

    def _target(self, k: int, at: float, inputs: Mapping[str, Any]) -> tuple[float, float, float]:
        names = DERIVATIVES[k]
        if not self.derivatives or names is None:
            return parabola(self.times, self.samples[k], at)
        v, a = (self.signs[k] * float(inputs[name]) for name in names)
        ahead = at - self.times[-1]
        return self.samples[k, -1] + ahead * (v + 0.5 * ahead * a), v + ahead * a, a

    def to_bytes(self) -> bytes:
        """The whole memory."""
        return b"".join(array.tobytes() for array in (self.times, self.samples, self.reached))

    def from_bytes(self, data: bytes) -> None:
        """Restore what `to_bytes` gave."""
        numbers = np.frombuffer(data, np.float64)
        self.times = numbers[:SAMPLES].copy()
        self.samples = numbers[SAMPLES : SAMPLES + PATHS * SAMPLES].reshape(PATHS, SAMPLES).copy()
        self.reached = numbers[SAMPLES + PATHS * SAMPLES :].reshape(PATHS, 3).copy()

    def __len__(self) -> int:
        """Number of bytes that `to_bytes` gives."""
        return 8 * (SAMPLES + PATHS * SAMPLES + PATHS * (PATH - 3))
