"""Linear finite elements of the reduced model: equally spaced nodes from the axle, xi = 0, to the end of the rope.

A tridiagonal matrix is stored as a band (3, n - 1): for each inner node the entries of the previous node, itself and the next
one; the first and the last belong to the ends. The mass matrix is the mean of consistent and lumped mass, so that waves of six
elements and longer have the correct speed.
"""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

ELEMENTS = 96  # the car's bounce on its hoist ropes makes waves a seventeenth as long as a side of 200 m


class Matrices(NamedTuple):
    """The integrals over xi of f_i f_j (`mass`), (1 - xi) f_i f_j' (`G`), (1 - xi)^2 f_i' f_j' (`S`), f_i' f_j' (`K`) and
    xi f_i' f_j' (`H`).
    """

    mass: Floats
    G: Floats
    S: Floats
    K: Floats
    H: Floats


@cache
def matrices() -> Matrices:
    """The matrices as bands, exact except for the mass."""
    h, a = 1.0 / ELEMENTS, np.arange(ELEMENTS) / ELEMENTS
    pull = np.array([[1.0, -1.0], [-1.0, 1.0]]) / h
    near, far = (h * (0.5 * (1.0 - a) - h * share) for share in (1.0 / 6.0, 1.0 / 3.0))  # of (1 - xi) f
    G = np.array([[-near, near], [-far, far]]).transpose(2, 0, 1) / h
    S, H = ((1.0 - a) ** 3 - (1.0 - a - h) ** 3) / (3.0 * h), a + 0.5 * h

    def weighted(weight: Floats) -> Floats:
        return _band(weight[:, None, None] * pull)

    mass = np.tile(h / 12.0 * np.array([[5.0, 1.0], [1.0, 5.0]]), (ELEMENTS, 1, 1))
    return Matrices(_band(mass), _band(G), weighted(S), weighted(np.ones(ELEMENTS)), weighted(H))


def _band(parts: Floats) -> Floats:
    """Assemble element matrices (n, 2, 2) to a band."""
    return np.array([parts[:-1, 1, 0], parts[:-1, 1, 1] + parts[1:, 0, 0], parts[1:, 0, 1]])


def dense(band: Floats) -> Floats:
    """The full matrix (n - 1, n - 1) of the inner nodes."""
    return np.diag(band[1]) + np.diag(band[0, 1:], -1) + np.diag(band[2, :-1], 1)


def band_times(band: Floats, y: Floats) -> Floats:
    """Product of a band with values at all nodes (n + 1,)."""
    return np.asarray(band[0] * y[:-2] + band[1] * y[1:-1] + band[2] * y[2:])


@cache
def nodes() -> Floats:
    """Coordinates xi of the nodes (n + 1,)."""
    return np.linspace(0.0, 1.0, ELEMENTS + 1)


def interpolation_matrix(xi: Floats) -> Floats:
    """Interpolation matrix (m, n + 1) from nodes to coordinates xi (m,)."""
    return np.maximum(0.0, 1.0 - ELEMENTS * np.abs(np.asarray(xi)[:, None] - nodes()))
