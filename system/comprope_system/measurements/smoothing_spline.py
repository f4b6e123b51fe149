"""A quintic smoothing spline, at rest at its ends, whose smoothness is chosen by maximum likelihood.

The spline is the most likely motion of a car whose jerk is white noise, measured by a noisy sensor;
the ratio of the two noise levels maximises the restricted likelihood of the signal
(Patterson and Thompson 1971).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_array, diags_array, eye_array, vstack

from .trip import Piece

Floats = NDArray[np.float64]

DEGREE = 5
SPACING = 0.04  # s between knots; faster motion of the car does not excite the rope
MOST_INTERVALS = 20000
RANGE = (-10.0, 5.0)  # bounds of log10 of the weight of the penalty relative to the data


@dataclass(frozen=True)
class Smoothed:
    """The smooth curve, -2 log likelihood of the signal, and the same for a constant."""

    piece: Piece
    criterion: float
    constant_criterion: float


def smooth(time: Floats, signal: Floats, start: float, stop: float, rest_after: bool = True) -> Smoothed:
    """The smoothing spline of a signal between `start` and `stop` [s].

    Velocity and acceleration vanish at `start` and, with `rest_after`, at `stop`; samples beyond
    those times count for the constant values held there. `time`, `signal`: (n,).
    """
    knots = _knots(start, stop)
    tie = _tie(len(knots) - DEGREE - 1, rest_after)
    design = csr_array(BSpline.design_matrix(np.clip(time, start, stop), knots, DEGREE)) @ tie
    roughness = _third_derivative(knots) @ tie
    offset = float(np.mean(signal))
    problem = _Problem(design, roughness, signal - offset)
    best = minimize_scalar(lambda weight: problem.solve(weight)[0], bounds=RANGE, method="bounded", options={"xatol": 0.02})
    criterion, coefficients = problem.solve(best.x)
    curve = BSpline(knots, tie @ coefficients + offset, DEGREE)
    return Smoothed(Piece(curve, start, stop), criterion, problem.solve(RANGE[1])[0])


def _knots(start: float, stop: float) -> Floats:
    intervals = int(np.clip(np.ceil((stop - start) / SPACING), 8, MOST_INTERVALS))
    inner = np.linspace(start, stop, intervals + 1)
    return np.concatenate((np.full(DEGREE, start), inner, np.full(DEGREE, stop)))


def _tie(count: int, rest_after: bool) -> csr_array:
    """Matrix from the free coefficients to all: three equal coefficients at an end make derivatives there vanish."""
    free = eye_array(count - 2, format="csr")
    parts = [free[:1], free[:1], free]
    tie = csr_array(vstack(parts))
    if not rest_after:
        return tie
    keep = np.minimum(np.arange(count), count - 3)
    return csr_array(tie[keep][:, : count - 4])


def _third_derivative(knots: Floats) -> csr_array:
    """Matrix from coefficients to the third derivative at Gauss points, so weighted that squares sum to the integral."""
    matrix, inner = eye_array(len(knots) - DEGREE - 1, format="csr"), knots
    for degree in range(DEGREE, DEGREE - 3, -1):
        width = inner[degree + 1 : -1] - inner[1 : -degree - 1]
        count = len(width)
        step = diags_array([np.full(count, -1.0), np.ones(count)], offsets=[0, 1], shape=(count, count + 1))
        matrix, inner = diags_array(degree / width) @ step @ matrix, inner[1:-1]
    breaks = np.unique(knots)
    nodes, weights = np.polynomial.legendre.leggauss(3)
    half = 0.5 * np.diff(breaks)
    points = (breaks[:-1] + half)[:, None] + half[:, None] * nodes
    scale = np.sqrt(half[:, None] * weights).ravel()
    design = csr_array(BSpline.design_matrix(points.ravel(), inner, DEGREE - 3))
    return csr_array(diags_array(scale) @ design @ matrix)


class _Problem:
    """Penalised least squares with banded normal matrices."""

    def __init__(self, design: csr_array, roughness: csr_array, signal: Floats) -> None:
        self.data, penalty = _banded(design.T @ design), _banded(roughness.T @ roughness)
        self.penalty = penalty * (self.data[0].sum() / penalty[0].sum())
        self.right, self.square = design.T @ signal, float(signal @ signal)
        self.count, self.rank = len(signal), self.data.shape[1] - 1

    def solve(self, weight: float) -> tuple[float, Floats]:
        """-2 log restricted likelihood (less a constant) and coefficients for log10 of the penalty's weight."""
        factor = cholesky_banded(self.data + 10.0**weight * self.penalty, lower=True)
        coefficients = cho_solve_banded((factor, True), self.right)
        # Lower bound for the likelihood of a signal without noise: the rounding of values in the file.
        misfit = max(self.square - float(coefficients @ self.right), 1e-14 * self.count)
        determinant = 2.0 * np.log(factor[0]).sum() - self.rank * weight * np.log(10.0)
        return (self.count - 1) * np.log(misfit / self.count) + determinant, coefficients


def _banded(matrix: csr_array) -> Floats:
    """Lower diagonals (6, n) of a symmetric matrix of half-bandwidth 5."""
    size = matrix.shape[0]
    bands = np.zeros((DEGREE + 1, size))
    for offset in range(DEGREE + 1):
        bands[offset, : size - offset] = matrix.diagonal(-offset)
    return bands
