"""Gain-scheduled hoist: exact discretisations about a row of car positions, computed once before the simulation.

From one operating point to the next the ratio of the rope lengths, and with it every stiffness, changes by about 1 %; the
points are close together where a rope is short and far apart in the middle of a tall shaft.
"""

from bisect import bisect
from dataclasses import dataclass
from functools import lru_cache

import control
import numpy as np
from scipy.linalg import expm

from .hoist_dynamics import STATES, state_space
from .parameters import Drive

_RATIO_STEP = 0.01  # change of the logarithm of the ratio of the rope lengths between operating points
_N = len(STATES)


@dataclass(frozen=True)
class ScheduledPlant:
    """Linearisations about operating points; point i is used up to the car position `boundaries[i]` [m].

    A vector (11,) contains the hoist's states followed by its inputs. `rate_matrices[i]` (8, 11) gives the derivatives of
    the states, `step_matrices[i]` (8, 11) the states one sample period later.
    """

    boundaries: list[float]
    rate_matrices: tuple[np.ndarray, ...]
    step_matrices: tuple[np.ndarray, ...]

    def operating_point(self, position: float) -> int:
        """Index of the operating point for a car position [m]; the outermost points are used for all positions beyond them."""
        return bisect(self.boundaries, position)

    def advance_period(self, point: int, vector: np.ndarray) -> None:
        """Advance the states in the vector (11,) by one sample period with constant inputs."""
        vector[:_N] = self.step_matrices[point] @ vector

    def advance(self, point: int, vector: np.ndarray, duration: float) -> None:
        """Advance the states in the vector (11,) by `duration` [s] with constant inputs, exactly."""
        square = np.zeros((vector.size, vector.size))
        square[:_N] = duration * self.rate_matrices[point]
        vector[:_N] = (expm(square) @ vector)[:_N]


def scheduled_plant(drive: Drive) -> ScheduledPlant:
    """The scheduled plant of a drive; cached for resets, further instances and further trips."""
    return _scheduled_plant(drive.without_trips)


@lru_cache(maxsize=8)
def _scheduled_plant(drive: Drive) -> ScheduledPlant:
    centres = _operating_positions(drive.plant.headroom, drive.shaft.height)
    hoists = [state_space(drive, float(x)) for x in centres]
    sampled = [control.sample_system(hoist, drive.servo.sample_period, method="zoh") for hoist in hoists]
    return ScheduledPlant(
        list(0.5 * (centres[1:] + centres[:-1])),
        tuple(np.hstack([hoist.A, hoist.B]) for hoist in hoists),
        tuple(np.hstack([hoist.A, hoist.B]) for hoist in sampled),
    )


def _operating_positions(headroom: float, height: float) -> np.ndarray:
    """Car positions at which ln((headroom + x)/(headroom + height - x)) is a multiple of the step, about x = height / 2."""
    end = np.log1p(height / headroom)
    logs = np.linspace(-end, end, 2 * int(np.ceil(end / _RATIO_STEP)) + 1)
    return (2.0 * headroom + height) / (1.0 + np.exp(-logs)) - headroom
