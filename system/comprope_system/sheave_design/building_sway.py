"""Response of the rope of a parked car to building sway: closed-form solution of the reduced model at standstill.

The ends move with the building, in proportion to the height above the axle; the swing is relative to the
building. The response of mode k, of angular frequency w, to the sway s = A sin(W t), starting from rest, is

    q = F / (w^2 - W^2) (sin(W t) - (W / w) sin(w t)),   F = W^2 m_k A

with m_k the component of the mode in a straight line from axle to end, minus what bends the line (the line is not an equilibrium
shape if the tension increases with height). There is no damping, so that the swing at resonance grows with the duration.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..vibration.reduced_model.finite_elements import band_times, interpolation_matrix, matrices, nodes
from ..vibration.reduced_model.string_dynamics import standstill_modes
from ..vibration.reduced_model.swing import READ_POSITIONS, SIDES, ReducedModel

Floats = NDArray[np.float64]

STEP = 0.1  # s
MODES = 12  # of each side, the slowest
NEAR = 1e-6  # of W: nearer than that to a mode's frequency counts as beside it


@dataclass(frozen=True)
class BuildingSway:
    """Harmonic sway: amplitude at the top landing [m], period [s] and duration [s]."""

    amplitude: float
    period: float
    duration: float = 60.0


def parked_departures(reduced: ReducedModel, sway: BuildingSway, car: float) -> dict[str, Floats]:
    """Largest displacement relative to the building (places,) [m] at READ_POSITIONS of each side, car parked at `car` [m]."""
    return {side: _side(reduced, sway, float(reduced.length(side, np.array([car]))[0])) for side in SIDES}


def worst_parked(reduced: ReducedModel, sway: BuildingSway, cars: Floats) -> tuple[float, float]:
    """Largest displacement [m] over car positions, and that position [m]."""
    found = [max(float(one.max()) for one in parked_departures(reduced, sway, float(car)).values()) for car in cars]
    return max(found), float(cars[int(np.argmax(found))])


def _side(reduced: ReducedModel, sway: BuildingSway, length: float) -> Floats:
    W = 2.0 * np.pi / sway.period
    squares, modes, stiffness = standstill_modes(reduced.rope, length)
    squares, modes = squares[:MODES], modes[:, :MODES]
    amplitude = sway.amplitude * length / (reduced.height + reduced.pit)
    force = amplitude * modes.T @ (W**2 * band_times(matrices().mass, nodes()) - band_times(stiffness, nodes()))
    w = np.sqrt(squares)
    w = np.where(np.abs(w - W) < NEAR * W, (1.0 + NEAR) * W, w)
    t = np.arange(0.0, sway.duration, STEP)[:, None]
    q = force / (w**2 - W**2) * (np.sin(W * t) - W / w * np.sin(w * t))
    return np.asarray(np.abs(q @ modes.T @ interpolation_matrix(READ_POSITIONS)[:, 1:-1].T).max(axis=0))
