"""A run-up before a record that begins under way: the rope can be brought to equilibrium at rest only."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

from .trip import Piece, Sequence, Trip, constant

Floats = NDArray[np.float64]

ACCELERATION = 0.8  # m/s2; mean of the run-up, that of a usual drive
SHORTEST, LONGEST = 1.0, 20.0  # s
STANDS = 1e-6  # m/s; a slower end is at rest


def run_up_time(trip: Trip, begin: float, height: float) -> float:
    """Duration [s] of a run-up from rest that remains in a shaft of this height [m]; 0 for a trip that begins at rest."""
    position, speed = float(trip.position(begin)), _speed(trip, begin)
    if abs(speed) < STANDS:
        return 0.0
    room = position if speed > 0.0 else height - position
    duration = float(np.clip(abs(speed) / ACCELERATION, SHORTEST, LONGEST))
    # The run-up takes half the way that the speed would; close to a landing it is as short as the way there.
    return min(duration, max(2.0 * room / abs(speed), 0.1 * SHORTEST))


def with_run_up(trip: Trip, begin: float, duration: float) -> Trip:
    """The trip preceded by a run-up of this duration [s], which reaches its position and speed at `begin` [s]."""
    if duration == 0.0:
        return trip
    position, speed = float(trip.position(begin)), _speed(trip, begin)
    # The speed rises as 3 s^2 - 2 s^3.
    climb = np.array([-0.5, 1.0, 0.0, 0.0, 0.0]) * speed / duration ** np.array([3.0, 2.0, 1.0, 0.0, -1.0])
    rise = PPoly(climb[:, None], [begin - duration, begin])
    # Inclusive of `begin`, where the derivatives of the trip's own pieces vanish.
    before = (
        Piece(rise, begin - duration, np.nextafter(begin, np.inf)),
        Piece(constant(position - 0.5 * speed * duration), begin, begin),
    )
    curve = Sequence((begin,), (before, trip.pieces))
    piece = Piece(curve, begin - duration, trip.rest_after)
    return Trip((piece,), trip.noise, trip.kind, trip.remarks)


def _speed(trip: Trip, begin: float) -> float:
    """Speed [m/s] just after `begin` [s]: derivatives vanish at the very beginning of a piece."""
    return float(trip.velocity(np.nextafter(begin, np.inf)))
