"""The smoothest motion within the noise of a signal: a cubic spline that bends sharply only where the signal requires it.

The integral of the squared jerk is minimised together with the squared misfit. Its weight is chosen by maximum
likelihood, as for the smoothing spline of a trip. Wherever the motion then misses the signal by more than its noise allows,
at a stop by the safety gear for instance, the weight is lowered and knots are added until it fits. A motion
without noise is thus taken as it is.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_array, diags_array

from .banded_least_squares import PenalisedProblem
from .local_misfit import excess
from .position_signal import Signal
from .smoothing_spline import MOST_INTERVALS, RANGE, SPACING, end_ties, third_derivative
from .trip import Piece

Floats = NDArray[np.float64]

DEGREE = 3  # accelerations are linear between knots
LOWERING = 10.0  # factor of the weight in one round
ROUNDS = 20  # lower the weight by up to 10^20, beyond which a spline interpolates
CLOSE = 0.6  # of the resolution: how near the motion comes to a signal without noise, half of it being rounding
REACH = 1  # intervals beyond a misfit in which the motion may bend more sharply too


def smooth_within_noise(signal: Signal, start: float, stop: float, rest_before: bool, rest_after: bool) -> Piece:
    """The smoothest curve between `start` and `stop` [s] that fits the signal; see the file's first lines.

    Velocity and acceleration vanish at `start` with `rest_before` and at `stop` with `rest_after`; samples beyond those
    times count for the constant values held there.
    """
    fit = _Spline(signal, start, stop, rest_before, rest_after)
    count = int(np.clip(np.ceil((stop - start) / SPACING), 8, MOST_INTERVALS))
    breaks, weights = np.linspace(start, stop, count + 1), np.ones(count)
    first = fit.problem(breaks, weights)
    best = minimize_scalar(lambda weight: first.solve(weight)[0], bounds=RANGE, method="bounded", options={"xatol": 0.05})
    curve = fit.curve(breaks, first.solve(best.x)[1])
    for _ in range(ROUNDS):
        misses = excess(signal, curve(fit.time), CLOSE) > 1.0
        if not misses.any():
            break
        breaks, weights = _sharper(breaks, weights, fit.time[misses], signal.interval)
        curve = fit.curve(breaks, fit.problem(breaks, weights, first.scale).solve(best.x)[1])
    return Piece(curve, start, stop)


class _Spline:
    """Splines of a signal between two times with any breaks between polynomials."""

    def __init__(self, signal: Signal, start: float, stop: float, rest_before: bool, rest_after: bool) -> None:
        self.time, self.rests = np.clip(signal.time, start, stop), (rest_before, rest_after)
        self.offset = float(np.mean(signal.position))
        self.position = signal.position - self.offset

    def problem(self, breaks: Floats, weights: Floats, scale: float | None = None) -> PenalisedProblem:
        """Least squares with a weight of the squared jerk in each interval."""
        knots, tie = self._basis(breaks)
        design = csr_array(BSpline.design_matrix(self.time, knots, DEGREE)) @ tie
        jerk = diags_array(weights**0.5) @ third_derivative(knots, DEGREE) @ tie
        return PenalisedProblem(design, csr_array(jerk), self.position, DEGREE, scale)

    def curve(self, breaks: Floats, coefficients: Floats) -> BSpline:
        """The spline with these free coefficients."""
        knots, tie = self._basis(breaks)
        return BSpline(knots, tie @ coefficients + self.offset, DEGREE)

    def _basis(self, breaks: Floats) -> tuple[Floats, csr_array]:
        knots = np.concatenate((np.full(DEGREE, breaks[0]), breaks, np.full(DEGREE, breaks[-1])))
        return knots, end_ties(len(knots) - DEGREE - 1, *self.rests)


def _sharper(breaks: Floats, weights: Floats, times: Floats, interval: float) -> tuple[Floats, Floats]:
    """Breaks and weights with lower weights around these times, and intervals halved that are longer than the samples'."""
    count = len(weights)
    at = np.clip(np.searchsorted(breaks, times, side="right") - 1, 0, count - 1)
    near = np.unique(np.clip(at[:, None] + np.arange(-REACH, REACH + 1), 0, count - 1))
    lowered = weights.copy()
    lowered[near] /= LOWERING
    wide = near[np.diff(breaks)[near] > 1.5 * interval]
    middles = 0.5 * (breaks[wide] + breaks[wide + 1])
    return np.insert(breaks, wide + 1, middles), np.insert(lowered, wide + 1, lowered[wide])
