"""A position signal with its noise and resolution."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

LEAST_NOISE = 1e-6  # m; lower bound of the noise, for signals that are exact for all practical purposes
HARD_STOP = 15.0  # m/s2; deceleration by a safety gear, beyond the 1 g that standards allow on the average
LONG_INTERVAL = 0.05  # s between samples from which on what a safety gear does within it is told from no failure of the sensor


@dataclass(frozen=True)
class Signal:
    """Positions (n,) [m] at increasing times (n,) [s], all finite; standard deviation of the noise and resolution [m].

    `local_noise` (n,) [m] is above `noise` where the signal is noisier for a while, as by uncertain times of a fast car. `held`
    is the interval [s] between new values of a signal that repeats them, 0 for others.
    """

    time: Floats
    position: Floats
    noise: float
    resolution: float
    local_noise: Floats
    held: float = 0.0

    def of(self, mask: Mask | slice) -> "Signal":
        """Some of the samples."""
        return Signal(self.time[mask], self.position[mask], self.noise, self.resolution, self.local_noise[mask], self.held)

    @property
    def rounded(self) -> bool:
        """Whether the signal has no noise but its rounding."""
        return _only_rounding(self.noise, self.resolution)

    @property
    def interval(self) -> float:
        """Median sampling interval [s]."""
        return float(np.median(np.diff(self.time)))

    @property
    def hidden(self) -> float:
        """Distance [m] that a hard stop within a long sampling interval takes from a steady motion; 0 for dense sampling."""
        return 0.5 * HARD_STOP * self.interval**2 if self.interval >= LONG_INTERVAL else 0.0


def _only_rounding(noise: float, resolution: float) -> bool:
    return noise <= max(resolution / 12.0**0.5, LEAST_NOISE)
