"""A tall building as a shear beam with a few modes: shapes, and their response to ground acceleration and to forces.

Shape of mode j, 1 or -1 at the top: sin((2 j - 1) pi s / 2), s the height over that of the building. Participation in a motion
of the ground: 4 / ((2 j - 1) pi). A. Chopra, *Dynamics of Structures*, chapters 16 and 17.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import StateSpace, lsim

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ModalBuilding:
    """Periods of the modes [s], slowest first, and the damping ratio of all."""

    periods: tuple[float, ...]
    damping: float

    def shape(self, mode: int, share: Floats) -> Floats:
        """Shape of a mode, from 0, at shares (n,) of the building's height."""
        return np.asarray(np.sin((mode + 0.5) * np.pi * share))

    def participation(self, mode: int) -> float:
        """How much of the ground's acceleration drives a mode."""
        return float(2.0 / ((mode + 0.5) * np.pi))

    def ground_response(self, mode: int, acceleration: Floats, step: float) -> Floats:
        """Modal coordinate (n,) [m] from rest under ground accelerations (n,) [m/s2], linear between samples a step [s] apart."""
        rate = 2.0 * np.pi / self.periods[mode]
        system = StateSpace([[0.0, 1.0], [-(rate**2), -2.0 * self.damping * rate]], [[0.0], [1.0]], [[1.0, 0.0]], [[0.0]])
        force = -self.participation(mode) * acceleration
        return np.asarray(lsim(system, force, step * np.arange(len(force)))[1]).ravel()

    def receptance(self, mode: int, frequency: Floats) -> NDArray[np.complex128]:
        """Modal coordinate over modal force per modal mass at frequencies [Hz]."""
        rate, own = 2.0 * np.pi * frequency, 2.0 * np.pi / self.periods[mode]
        return np.asarray(1.0 / (own**2 - rate**2 + 2j * self.damping * own * rate))
