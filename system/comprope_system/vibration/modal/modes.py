"""Natural periods and mode shapes of the suspended rope for a car position."""

from dataclasses import dataclass
from math import inf, pi

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import eigsh

from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope

from .linearisation import Linear, linearise

Floats = NDArray[np.float64]

SHARED = 0.1  # of the energy of one side on the other: the mode is of both


@dataclass(frozen=True)
class Mode:
    """One natural mode.

    `place` is where most of its motion is: "car" or "counterweight" for a lateral swing of that side, "both" where
    equal sides share it, "sheave" for what moves along the rope. `half_waves` counts those of the swing on a side,
    0 for "sheave".
    `shape` (n + 1, 2) is the displacement x (down), y of each node and of the sheave (height, angle times
    radius), its largest number 1.
    """

    period: float
    place: str
    half_waves: int
    shape: Floats

    @property
    def frequency(self) -> float:
        """Natural frequency [Hz]."""
        return 1.0 / self.period


@dataclass(frozen=True)
class Modes:
    """Modes by falling period, with the car at `car` [m]; `heights` (n,) are those of the nodes at rest [m]."""

    car: float
    heights: Floats
    modes: tuple[Mode, ...]

    def first(self, place: str = "counterweight", half_waves: int = 1) -> Mode:
        """The mode of a side with this number of half waves; raises `LookupError` if it was not computed."""
        for mode in self.modes:
            if mode.place in (place, "both") and mode.half_waves == half_waves:
                return mode
        raise LookupError(f"{place}, {half_waves}")


def modes(model: Base, car: float, count: int = 10) -> Modes:
    """The `count` modes of longest period with the car at `car` [m] and the counterweight at shaft height - `car`.

    Raises `InputError` or `SimulationError` if there is no static equilibrium.
    """
    rope = CompensationRope(model)
    rope.solve_equilibrium(car, model.shaft.height - car)
    small = linearise(rope)
    values, vectors = _slowest(small, min(count, len(small.mass) - 2))
    found = (_mode(rope, value, small.full(vector)) for value, vector in zip(values, vectors.T, strict=True))
    return Modes(car, -np.array(rope.state.q[: rope.n]), tuple(found))


def _slowest(small: Linear, count: int) -> tuple[Floats, Floats]:
    """The smallest squares of angular frequency (count,) and their vectors (k, count), by inverse iteration.

    Masses are scaled into the stiffness, so that the problem is an ordinary symmetric one.
    """
    root = 1.0 / np.sqrt(small.mass)
    scale = diags_array(root)
    start = np.random.default_rng(0).standard_normal(len(root))  # a fixed start gives the same digits each time
    values, vectors = eigsh(csc_array(scale @ small.stiffness @ scale), k=count, sigma=0.0, which="LM", v0=start)
    order = np.argsort(values)
    return values[order], root[:, None] * vectors[:, order]


def _mode(rope: CompensationRope, square: float, motion: Floats) -> Mode:
    n, x = rope.n, np.asarray(rope.state.q[: rope.n])
    shape = motion.T.copy()
    shape[n, 1] *= rope.model.sheave.radius
    shape /= shape.flat[np.argmax(np.abs(shape))]
    place, lowest = _place(rope, motion, x), int(np.argmax(x))
    side = slice(0, lowest) if place == "car" else slice(lowest, n)
    waves = 0 if place == "sheave" else _half_waves(shape[side, 1])
    # A sheave without friction turns freely, which rounding makes a square of either sign.
    return Mode(2.0 * pi / square**0.5 if square > 0.0 else inf, place, waves, shape)


def _place(rope: CompensationRope, motion: Floats, x: Floats) -> str:
    """Where most of the kinetic energy is: across the rope on either side, or along it and in the sheave."""
    node, sheave, lowest = rope.model.rope.mass_per_length * rope.element, rope.model.sheave, int(np.argmax(x))
    across = node * motion[1, :-1] ** 2
    turning = sheave.inertia_per_rope * motion[1, -1] ** 2
    along = node * (motion[0, :-1] ** 2).sum() + sheave.mass_per_rope * motion[0, -1] ** 2 + turning
    car, other = float(across[:lowest].sum()), float(across[lowest:].sum())
    if along > max(car, other):
        return "sheave"
    if min(car, other) > SHARED * max(car, other):
        return "both"
    return "car" if car > other else "counterweight"


def _half_waves(values: Floats) -> int:
    """Number of half waves of a shape: its sign changes, without small values, plus one."""
    large = values[np.abs(values) > 0.02 * np.abs(values).max()]
    return 1 + int(np.count_nonzero(np.diff(np.sign(large))))
