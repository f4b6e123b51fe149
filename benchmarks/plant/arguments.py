"""What the plant's compiled functions take: arrays in groups, for a rope of n nodes."""

from typing import NamedTuple

import numpy as np

from .tower import Floats


class Work(NamedTuple):
    """Arrays that the equations fill."""

    S: Floats  # [n, 6] segments
    m: Floats  # [n] moments
    kappa: Floats  # [n]
    f: Floats  # [2 n + 2]
    A: Floats  # [2 n + 5, 11]
    B: Floats  # [2, 2 n + 10]
    C: Floats  # [2, 2 n]
    D: Floats  # [2, 2]
    E: Floats  # [2, 2]
    x: Floats  # [2 n + 10]
    tensions: Floats  # [3] at the car, at the counterweight, and the sheave's force


class Rope(NamedTuple):
    """Masses [n] of the nodes; curvature and Dahl's state [n] at the end of the last step."""

    mass: Floats
    kappa0: Floats
    z0: Floats


class Ambience(NamedTuple):
    """Strain of the rope by temperature, and velocity of the car in its air [m/s]."""

    thermal: float
    wind: float


class Weights(NamedTuple):
    """Weights of the tangent ck K + cc C + cm M, and whether it is wanted."""

    ck: float
    cc: float
    cm: float
    tangent: bool


class State(NamedTuple):
    """Position, velocity and acceleration [2 n + 2]."""

    q: Floats
    v: Floats
    a: Floats


class Record(NamedTuple):
    """Places [count, 2] of sensors, side and height; every so many steps a row of `out` [rows, 6 + count]."""

    sensors: Floats
    every: int
    out: Floats


def work(n: int) -> Work:
    """Room for the equations."""
    zeros = np.zeros
    return Work(
        zeros((n, 6)), zeros(n), zeros(n), zeros(2 * n + 2), zeros((2 * n + 5, 11)), zeros((2, 2 * n + 10)),
        zeros((2, 2 * n)), zeros((2, 2)), zeros((2, 2)), zeros(2 * n + 10), zeros(3),
    )  # fmt: skip


def empty_state(n: int) -> State:
    """A state of zeros."""
    return State(np.zeros(2 * n + 2), np.zeros(2 * n + 2), np.zeros(2 * n + 2))
