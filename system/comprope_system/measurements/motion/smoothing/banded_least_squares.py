"""Penalised least squares with banded normal matrices, and the likelihood of the penalty's weight."""

from copy import copy
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded
from scipy.sparse import csr_array

Floats = NDArray[np.float64]

RIDGE = 1e-12  # of the largest diagonal element


class PenalisedProblem:
    """Least squares |design c - signal|^2 + weight scale |roughness c|^2 for the coefficients c of a spline of some degree.

    `scale` makes a weight of 1 balance both matrices, unless it is given.
    """

    def __init__(self, design: csr_array, roughness: csr_array, signal: Floats, degree: int, scale: float | None = None) -> None:
        self.degree = degree
        self.data, penalty = _banded(design.T @ design, degree), _banded(roughness.T @ roughness, degree)
        self.scale = self.data[0].sum() / penalty[0].sum() if scale is None else scale
        self.penalty = penalty * self.scale
        self.right, self.square = design.T @ signal, float(signal @ signal)
        self.count, self.rank = len(signal), self.data.shape[1] - 1

    def with_roughness(self, roughness: csr_array) -> Self:
        """The same problem with another roughness of the same scale."""
        other = copy(self)
        other.penalty = _banded(roughness.T @ roughness, self.degree) * self.scale
        return other

    def solve(self, weight: float) -> tuple[float, Floats]:
        """-2 log restricted likelihood (less a constant) and coefficients for log10 of the penalty's weight."""
        factor = _factor(self.data + 10.0**weight * self.penalty)
        coefficients = cho_solve_banded((factor, True), self.right)
        # Lower bound for the likelihood of a signal without noise: the rounding of values in the file.
        misfit = max(self.square - float(coefficients @ self.right), 1e-14 * self.count)
        determinant = 2.0 * np.log(factor[0]).sum() - self.rank * weight * np.log(10.0)
        return (self.count - 1) * np.log(misfit / self.count) + determinant, coefficients


def _factor(matrix: Floats) -> Floats:
    """Cholesky factor of a banded matrix; one that is singular in double precision is made regular."""
    try:
        return np.asarray(cholesky_banded(matrix, lower=True))
    except LinAlgError:
        matrix = matrix.copy()
        matrix[0] += RIDGE * matrix[0].max()
        return np.asarray(cholesky_banded(matrix, lower=True))


def _banded(matrix: csr_array, degree: int) -> Floats:
    """Lower diagonals (degree + 1, n) of a symmetric matrix."""
    size = matrix.shape[0]
    bands = np.zeros((degree + 1, size))
    for offset in range(degree + 1):
        bands[offset, : size - offset] = matrix.diagonal(-offset)
    return bands
