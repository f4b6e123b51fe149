"""Gain-scheduled hoist: exact discretisations about a row of car positions, computed once before the simulation.

From one operating point to the next the ratio of the rope lengths, and with it every stiffness, changes by about 1 %; the
points are close together where a rope is short and far apart in the middle of a tall shaft.
"""

from dataclasses import dataclass
from functools import lru_cache

import control
import numpy as np

from ..kernels.design import RATIO_STEP
from ..parameters import Drive
from .hoist_dynamics import state_space


@dataclass(frozen=True)
class ScheduledPlant:
    """Linearisations about n operating points; point i is used up to the car position `boundaries[i]` [m], (n - 1,).

    `rate_matrices` (n, 8, 11) give the derivatives of the states from the states followed by the inputs, `step_matrices`
    (n, 8, 11) the states one sample period later.
    """

    boundaries: np.ndarray
    rate_matrices: np.ndarray
    step_matrices: np.ndarray


def scheduled_plant(drive: Drive) -> ScheduledPlant:
    """The scheduled plant of a drive; cached for resets, further instances and further trips."""
    return _scheduled_plant(drive.without_trips)


@lru_cache(maxsize=8)
def _scheduled_plant(drive: Drive) -> ScheduledPlant:
    centres = _operating_positions(drive.plant.headroom, drive.shaft.height)
    hoists = [state_space(drive, float(x)) for x in centres]
    sampled = [control.sample_system(hoist, drive.servo.sample_period, method="zoh") for hoist in hoists]
    return ScheduledPlant(
        0.5 * (centres[1:] + centres[:-1]),
        np.array([np.hstack([hoist.A, hoist.B]) for hoist in hoists]),
        np.array([np.hstack([hoist.A, hoist.B]) for hoist in sampled]),
    )


def _operating_positions(headroom: float, height: float) -> np.ndarray:
    """Car positions at which ln((headroom + x)/(headroom + height - x)) is a multiple of the step, about x = height / 2."""
    end = np.log1p(height / headroom)
    logs = np.linspace(-end, end, 2 * int(np.ceil(end / RATIO_STEP)) + 1)
    return (2.0 * headroom + height) / (1.0 + np.exp(-logs)) - headroom
