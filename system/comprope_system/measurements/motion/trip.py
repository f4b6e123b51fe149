"""A smooth trip: position, velocity and acceleration of the car at any time, at rest before and after."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PPoly

Curve = Callable[..., NDArray[np.float64]]


ENDS_UNDER_WAY = "the record ends under way"


@dataclass(frozen=True)
class Piece:
    """A curve `curve(t, derivative)` between `start` and `stop` [s], constant outside."""

    curve: Curve
    start: float
    stop: float

    def value(self, time: NDArray[np.float64]) -> NDArray[np.float64]:
        """The curve's value, held before `start` and after `stop`."""
        return self.curve(np.clip(time, self.start, self.stop))

    def derivative(self, time: NDArray[np.float64], order: int) -> NDArray[np.float64]:
        """The curve's derivative, exactly zero outside."""
        inside = (time > self.start) & (time < self.stop)
        return np.where(inside, self.curve(np.clip(time, self.start, self.stop), order), 0.0)


@dataclass(frozen=True)
class Trip:
    """A trip as a sum of pieces.

    `noise` [m] is one standard deviation of the signal it was recovered from. The car is exactly at
    rest until `rest_before` and from `rest_after` on [s]; `rest_after` is infinite when the record
    ends before the trip does. `kind` is the representation: rest, profile, spline, profile and spline, exact (within the
    noise at every sample), or trips (several in one record). `remarks` are sentences about the recovery.
    """

    pieces: tuple[Piece, ...]
    noise: float
    kind: str
    remarks: tuple[str, ...] = ()

    @property
    def rest_before(self) -> float:
        """The time until which the car is at rest [s]."""
        return min((piece.start for piece in self.pieces), default=-np.inf)

    @property
    def rest_after(self) -> float:
        """The time from which the car is at rest again [s]."""
        return max((piece.stop for piece in self.pieces), default=np.inf)

    def mirrored(self, height: float) -> "Trip":
        """The trip of the counterweight in a shaft of this height [m]: height less the car's position."""
        return self.scaled(-1.0, height)

    def scaled(self, factor: float, shift: float) -> "Trip":
        """The trip with positions `factor` times as large plus `shift` [m]."""
        pieces = tuple(Piece(partial(_scaled, factor, one.curve), one.start, one.stop) for one in self.pieces)
        level = Piece(constant(shift), self.rest_before, self.rest_before)
        return Trip((*pieces, level), abs(factor) * self.noise, self.kind, self.remarks)

    def position(self, time: ArrayLike) -> NDArray[np.float64]:
        """Height of the car [m] at `time` [s], any shape."""
        t = np.asarray(time, dtype=float)
        return sum((piece.value(t) for piece in self.pieces), np.zeros(t.shape))

    def velocity(self, time: ArrayLike) -> NDArray[np.float64]:
        """Velocity of the car [m/s] at `time` [s], any shape."""
        return self._derivative(time, 1)

    def acceleration(self, time: ArrayLike) -> NDArray[np.float64]:
        """Acceleration of the car [m/s2] at `time` [s], any shape."""
        return self._derivative(time, 2)

    def _derivative(self, time: ArrayLike, order: int) -> NDArray[np.float64]:
        t = np.asarray(time, dtype=float)
        return sum((piece.derivative(t, order) for piece in self.pieces), np.zeros(t.shape))


@dataclass(frozen=True)
class Sequence:
    """The curve of motions that follow each other: the sum of the pieces of one of `parts`, which change at `breaks` [s]."""

    breaks: tuple[float, ...]
    parts: tuple[tuple[Piece, ...], ...]

    def __call__(self, time: NDArray[np.float64], order: int = 0) -> NDArray[np.float64]:
        """Value or derivative at times of any shape."""
        t = np.asarray(time, dtype=float)
        at = np.searchsorted(self.breaks, t)
        result = np.zeros(t.shape)
        for k in np.unique(at):
            here = at == k
            pieces = (one.derivative(t[here], order) if order else one.value(t[here]) for one in self.parts[k])
            result[here] = sum(pieces, np.zeros(int(np.sum(here))))
        return result


def constant(value: float) -> Curve:
    """The constant curve."""
    return partial(_constant, value)


# Module functions, not closures: trips are pickled when they are sent to other processes.
def _constant(value: float, time: NDArray[np.float64], order: int = 0) -> NDArray[np.float64]:
    return np.full(np.shape(time), 0.0 if order else value)


def _scaled(factor: float, curve: Curve, time: NDArray[np.float64], order: int = 0) -> NDArray[np.float64]:
    return factor * curve(time, order)


def smooth_step(start: float, stop: float, height: float) -> Curve:
    """The quintic from 0 at `start` to `height` at `stop` [s], without velocity and acceleration at both."""
    s = np.array([[6.0], [-15.0], [10.0], [0.0], [0.0], [0.0]]) / (stop - start) ** np.arange(5, -1, -1)[:, None]
    return PPoly(height * s, [start, stop])


def continued(piece: Piece) -> Piece:
    """The piece without a stop: it goes on at the speed it has there."""
    return Piece(partial(_continued, piece.curve, piece.stop), piece.start, np.inf)


def _continued(curve: Curve, stop: float, time: NDArray[np.float64], order: int = 0) -> NDArray[np.float64]:
    beyond = np.asarray(time) > stop
    inside = curve(np.minimum(time, stop), order)
    if order > 1:
        return np.where(beyond, 0.0, inside)
    speed = curve(np.float64(stop), 1)
    return np.where(beyond, inside + (np.maximum(time, stop) - stop) * speed, inside) if order == 0 else inside
