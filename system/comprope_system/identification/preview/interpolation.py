"""Interpolation of predictions between nodes on lines through one point, from values and derivatives there.

Each parameter has a line of nodes on which it varies while the others keep their values at the common point, the centre. Along a
line the interpolant is the piecewise cubic of Hermite. With two parameters u and v, y = A(u) + B(v) - y* + C: the cubics of both
lines, and for the mixed part C the change of each derivative along the other line (cubics of Lagrange),

    C = (v - v*) (y_v(u, v*) - y_v*) + (u - u*) (y_u(u*, v) - y_u*) - (u - u*) (v - v*) y_uv*,

which is exact to third order about the centre. The interpolant is linear in the data, so that its error against measurements is a
quadratic form of the weights (see `effect_preview`). `report/preview.js` computes the same weights.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class NodeLines:
    """Nodes of one or two parameters: `lines[k]` are the values of parameter k, `centres[k]` the number of the centre on it.

    Nodes are numbered: the centre, then the others of each line. Each has a value and a derivative by each parameter; data and
    weights are in that order, node by node: (nodes * (1 + parameters),).
    """

    lines: tuple[tuple[float, ...], ...]
    centres: tuple[int, ...]

    @property
    def centre(self) -> tuple[float, ...]:
        """The parameters at the centre."""
        return tuple(line[k] for line, k in zip(self.lines, self.centres, strict=True))

    def points(self) -> list[tuple[float, ...]]:
        """The parameters of each node."""
        found = [self.centre]
        for k, line in enumerate(self.lines):
            others = [value for j, value in enumerate(line) if j != self.centres[k]]
            found += [(*self.centre[:k], value, *self.centre[k + 1 :]) for value in others]
        return found

    def weights(self, at: Sequence[float]) -> Floats:
        """Weights of all data at the parameters `at`, each within the range of its line."""
        count = len(self.lines)
        places = [np.array(self._numbers(k)) * (1 + count) for k in range(count)]
        found = np.zeros((1 + sum(len(line) - 1 for line in self.lines)) * (1 + count))
        found[0] = 1.0 - count
        for k, (line, x) in enumerate(zip(self.lines, at, strict=True)):
            values, slopes = hermite_weights(line, x)
            found[places[k]] += values
            found[places[k] + 1 + k] += slopes
        if count == 2:
            self._add_mixed_part(found, places, at)
        return found

    def _numbers(self, k: int) -> list[int]:
        """Numbers of the nodes on line k, in the order of its values."""
        before = 1 + sum(len(line) - 1 for line in self.lines[:k])
        others = iter(range(before, before + len(self.lines[k])))
        return [0 if j == self.centres[k] else next(others) for j in range(len(self.lines[k]))]

    def _add_mixed_part(self, found: Floats, places: Sequence[NDArray[np.int64]], at: Sequence[float]) -> None:
        """Add the weights of the part C of two parameters."""
        du, dv = (x - centre for x, centre in zip(at, self.centre, strict=True))
        for k, (own, other) in enumerate(((du, dv), (dv, du))):
            derivative = places[k] + 2 - k  # by the other parameter, along line k
            found[derivative] += other * lagrange_weights(self.lines[k], at[k])
            found[2 - k] -= other
            found[derivative] -= 0.5 * own * other * lagrange_slopes(self.lines[k], self.centres[k])


def hermite_weights(nodes: Sequence[float], x: float) -> tuple[Floats, Floats]:
    """Weights of values and of derivatives (nodes,) of the piecewise cubic through them at x."""
    j = int(np.clip(np.searchsorted(nodes, x) - 1, 0, len(nodes) - 2)) if nodes[0] < nodes[-1] else _descending(nodes, x)
    h = nodes[j + 1] - nodes[j]
    t = (x - nodes[j]) / h
    values, slopes = np.zeros(len(nodes)), np.zeros(len(nodes))
    values[j], values[j + 1] = (1.0 + 2.0 * t) * (1.0 - t) ** 2, t**2 * (3.0 - 2.0 * t)
    slopes[j], slopes[j + 1] = h * t * (1.0 - t) ** 2, h * t**2 * (t - 1.0)
    return values, slopes


def _descending(nodes: Sequence[float], x: float) -> int:
    """The interval of nodes that fall, as those of a negative parameter do."""
    return int(np.clip(np.searchsorted([-one for one in nodes], -x) - 1, 0, len(nodes) - 2))


def lagrange_weights(nodes: Sequence[float], x: float) -> Floats:
    """Weights (nodes,) of the polynomial through all nodes at x."""
    return np.array([np.prod([(x - b) / (a - b) for b in nodes if b != a]) for a in nodes])


def lagrange_slopes(nodes: Sequence[float], centre: int) -> Floats:
    """Weights (nodes,) of the derivative of that polynomial at one of the nodes."""
    at = nodes[centre]
    found = np.zeros(len(nodes))
    for k, a in enumerate(nodes):
        if k != centre:
            others = [b for j, b in enumerate(nodes) if j not in (k, centre)]
            found[k] = np.prod([(at - b) / (a - b) for b in others]) / (a - at)
    found[centre] = -found.sum()
    return found
