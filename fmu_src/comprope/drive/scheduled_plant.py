"""Gain-scheduled hoist: exact discretisations about a row of car positions, computed once before the simulation.

Each cell spans 1 % of the ratio of the rope lengths, so that stiffnesses change by about 1 % from
one cell to the next; cells are small where a rope is short and large in the middle of a tall shaft.
"""

from bisect import bisect
from dataclasses import dataclass
from functools import lru_cache

import control
import numpy as np
from scipy.linalg import expm

from .hoist_dynamics import STATES, state_space
from .parameters import Drive

_SPAN = 0.01
_N = len(STATES)


@dataclass(frozen=True)
class Cells:
    """Linearisations by car position; cell i extends up to `bounds[i]` [m].

    A full vector (11,) contains the hoist's states followed by its inputs. `rates[i]` (8, 11) gives the derivatives of the
    states, `steps[i]` (8, 11) the states one sample period later.
    """

    bounds: list[float]
    rates: tuple[np.ndarray, ...]
    steps: tuple[np.ndarray, ...]

    def at(self, position: float) -> int:
        """Index of the cell of a car position [m]; the outermost cells are unbounded."""
        return bisect(self.bounds, position)

    def period(self, cell: int, full: np.ndarray) -> None:
        """Advance the states in the full vector (11,) by one sample period with constant inputs."""
        full[:_N] = self.steps[cell] @ full

    def part(self, cell: int, full: np.ndarray, duration: float) -> None:
        """Advance the states in the full vector (11,) by `duration` [s] with constant inputs, exactly."""
        square = np.zeros((full.size, full.size))
        square[:_N] = duration * self.rates[cell]
        full[:_N] = (expm(square) @ full)[:_N]


def cells(drive: Drive) -> Cells:
    """The cells of a drive; cached for resets, further instances and further trips."""
    return _cells(drive.standing)


@lru_cache(maxsize=8)
def _cells(drive: Drive) -> Cells:
    centres = _centres(drive.plant.headroom, drive.shaft.height)
    hoists = [state_space(drive, float(x)) for x in centres]
    sampled = [control.sample_system(hoist, drive.servo.sample_period, method="zoh") for hoist in hoists]
    return Cells(
        list(0.5 * (centres[1:] + centres[:-1])),
        tuple(np.hstack([hoist.A, hoist.B]) for hoist in hoists),
        tuple(np.hstack([hoist.A, hoist.B]) for hoist in sampled),
    )


def _centres(headroom: float, height: float) -> np.ndarray:
    """Car positions at which ln((headroom + x)/(headroom + height - x)) is a multiple of the span, about x = height / 2."""
    end = np.log1p(height / headroom)
    logs = np.linspace(-end, end, 2 * int(np.ceil(end / _SPAN)) + 1)
    return (2.0 * headroom + height) / (1.0 + np.exp(-logs)) - headroom
