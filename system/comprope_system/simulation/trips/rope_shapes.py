"""Recorded shapes of the rope in a trip: both sides, the rope around the sheave, and the position of the sheave."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.side_shape import Floats, side_shape

SIDES = ("car", "counterweight")
POINTS = 80  # along each side, from its end down to the axle's height
DEPTHS = (
    1.0 - (1.0 - np.linspace(0.0, 1.0, POINTS)) ** 1.5
)  # how far down each is: closer together where the rope bends onto the sheave
ARC = 48  # along the rope round the sheave
REACH = 1.6  # radii above the axle up to which that rope is kept
FRAME_RATE = 20.0  # frames a second: a rope's lower modes in a shaft are slower than 2 Hz
REST_POSITIONS = 60  # of the ends at which the static shape is computed: it changes little from one to the next
MAX_FRAMES = 1200  # frames; a longer trip has fewer of them a second


@dataclass(frozen=True)
class Frame:
    """One instant: heights of the two ends [m], outward displacement of both sides (2, POINTS) [m], upper end first;
    the rope around the sheave (2, ARC): to the counterweight's side and above the built axle [m]; axle's rise [m]; angle [rad].
    """

    ends: Floats
    sides: Floats
    arc: Floats
    axle: float
    angle: float


@dataclass(frozen=True)
class Recording:
    """The frames of a trip, one every `interval` [s]."""

    frames: tuple[Frame, ...]
    interval: float


def frame_of(rope: CompensationRope) -> Frame:
    """Frame of a rope in its present state. Points of a side that folds back below a height are NaN."""
    n, q, pit = rope.n, rope.state.q, rope.model.shaft.pit
    ends = np.array([-q[0], -q[n - 1]])
    return Frame(ends, _sides(rope), _arc(rope, pit), pit - float(q[n]), float(q[2 * n + 1]))


def rest_shapes(model: Base, frames: Iterable[Frame]) -> list[Floats]:
    """Static shapes (2, POINTS) [m] of the sides for the positions of the ends in each frame."""
    rope, found = CompensationRope(model), []
    for frame in frames:
        rope.solve_equilibrium(*frame.ends)
        found.append(_sides(rope))
    return found


def rest_displacements(model: Base, cars: Floats, counterweights: Floats) -> Floats:
    """Outward displacement (sensors, n) [m] of the static shape at each sensor, for heights (n,) [m] of the rope's ends.

    NaN where the rope has passed the sensor. Shapes are computed at REST_POSITIONS of the trip and interpolated between them.
    """
    moved = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(cars)) + np.abs(np.diff(counterweights)))])
    places = np.searchsorted(moved, np.linspace(0.0, moved[-1], REST_POSITIONS if moved[-1] > 0.0 else 1))
    chosen = np.unique(places.clip(0, len(cars) - 1))
    rope, found = CompensationRope(model), []
    for k in chosen:
        rope.solve_equilibrium(float(cars[k]), float(counterweights[k]))
        found.append([rope.lateral_displacement(one.side, one.height) for one in model.sensors])
    table = np.array([[value if seen else np.nan for value, seen in row] for row in found]).reshape(len(chosen), -1)
    return np.array([np.interp(moved, moved[chosen], column) for column in table.T])


def _sides(rope: CompensationRope) -> Floats:
    n, q = rope.n, rope.state.q
    heights = [-end + DEPTHS * (end - q[n]) for end in (q[0], q[n - 1])]
    return np.array([side_shape(rope, side, at) for side, at in zip(SIDES, heights, strict=True)])


def _arc(rope: CompensationRope, pit: float) -> Floats:
    """The lowest stretch of the rope, evenly spread over its nodes."""
    n, q = rope.n, rope.state.q
    low = np.flatnonzero(q[:n] > q[n] - REACH * rope.model.sheave.radius)
    at, nodes = np.linspace(low[0], low[-1], ARC), np.arange(n)
    return np.array([np.interp(at, nodes, q[n + 1 : -1]), pit - np.interp(at, nodes, q[:n])])


class FrameRecorder:
    """Records a frame every few communication steps of `step` [s]; called after each step, including the start.

    `rope` returns the present rope object, which may be replaced before the first step.
    """

    def __init__(self, rope: Callable[[], CompensationRope], step: float) -> None:
        self._rope, self._step = rope, step
        self._stride = 1
        self.frames: list[Frame] = []

    @property
    def interval(self) -> float:
        """Time between frames [s]."""
        return self._stride * self._step

    @property
    def recording(self) -> Recording:
        """The frames recorded so far."""
        return Recording(tuple(self.frames), self.interval)

    def __call__(self, count: int, total: int) -> None:
        """After `count` of `total` steps."""
        if count == 0:
            self._stride = max(1, round(1.0 / (FRAME_RATE * self._step)), -(-total // MAX_FRAMES))
        if count % self._stride == 0:
            self.frames.append(frame_of(self._rope()))
