"""A quintic smoothing spline, at rest at its ends, whose smoothness is chosen by maximum likelihood.

The spline is the most likely motion of a car whose jerk is white noise, measured by a noisy sensor;
the ratio of the two noise levels maximises the restricted likelihood of the signal
(Patterson and Thompson 1971).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_array, diags_array, eye_array

from ..trip import Piece
from .banded_least_squares import PenalisedProblem

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
    tie = end_ties(len(knots) - DEGREE - 1, True, rest_after)
    design = csr_array(BSpline.design_matrix(np.clip(time, start, stop), knots, DEGREE)) @ tie
    roughness = third_derivative(knots, DEGREE) @ tie
    offset = float(np.mean(signal))
    problem = PenalisedProblem(design, roughness, signal - offset, DEGREE)
    best = minimize_scalar(lambda weight: problem.solve(weight)[0], bounds=RANGE, method="bounded", options={"xatol": 0.02})
    criterion, coefficients = problem.solve(best.x)
    curve = BSpline(knots, tie @ coefficients + offset, DEGREE)
    return Smoothed(Piece(curve, start, stop), criterion, problem.solve(RANGE[1])[0])


def _knots(start: float, stop: float) -> Floats:
    intervals = int(np.clip(np.ceil((stop - start) / SPACING), 8, MOST_INTERVALS))
    inner = np.linspace(start, stop, intervals + 1)
    return np.concatenate((np.full(DEGREE, start), inner, np.full(DEGREE, stop)))


def end_ties(count: int, rest_before: bool, rest_after: bool) -> csr_array:
    """Matrix from the free coefficients to all: three equal coefficients at an end make derivatives there vanish."""
    kept = np.clip(np.arange(count), 2 if rest_before else 0, count - 3 if rest_after else count - 1)
    free = np.unique(kept)
    shape = (count, len(free))
    return csr_array((np.ones(count), (np.arange(count), np.searchsorted(free, kept))), shape=shape)


def third_derivative(knots: Floats, degree: int) -> csr_array:
    """Matrix from coefficients to the third derivative at Gauss points, so weighted that squares sum to the integral."""
    matrix, inner = eye_array(len(knots) - degree - 1, format="csr"), knots
    for order in range(degree, degree - 3, -1):
        width = inner[order + 1 : -1] - inner[1 : -order - 1]
        count = len(width)
        step = diags_array([np.full(count, -1.0), np.ones(count)], offsets=[0, 1], shape=(count, count + 1))
        matrix, inner = diags_array(order / width) @ step @ matrix, inner[1:-1]
    breaks = np.unique(knots)
    nodes, weights = np.polynomial.legendre.leggauss(degree - 2)
    half = 0.5 * np.diff(breaks)
    points = (breaks[:-1] + half)[:, None] + half[:, None] * nodes
    scale = np.sqrt(half[:, None] * weights).ravel()
    design = csr_array(BSpline.design_matrix(points.ravel(), inner, degree - 3))
    return csr_array(diags_array(scale) @ design @ matrix)
