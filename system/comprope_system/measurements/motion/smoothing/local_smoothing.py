"""The smoothest motion within the noise of a signal: a cubic spline that bends sharply only where the signal requires it.

The integral of the squared jerk is minimised together with the squared misfit. Its weight is chosen by maximum
likelihood, as for the smoothing spline of a trip. Wherever the motion then misses the signal by more than its noise allows,
at a stop by the safety gear for instance, jerks beyond the usual one count in proportion to their size only (Huber 1964): the
acceleration may jump, at times between the samples too, and does not ring before and after. Knots are added there, and the
weight is lowered until it fits. A motion without noise is thus taken as it is.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.optimize import minimize_scalar
from scipy.sparse import csr_array, diags_array

from ..signal.local_misfit import excess
from ..signal.position_signal import Signal
from ..trip import Piece
from .banded_least_squares import PenalisedProblem
from .smoothing_spline import MOST_INTERVALS, RANGE, SPACING, end_ties, third_derivative

Floats = NDArray[np.float64]

DEGREE = 3  # accelerations are linear between knots
LOWERING = 3.0  # factor of the weight in one round
ROUNDS = 20  # lower the weight by up to 3^20, beyond which a spline interpolates
REWEIGHTINGS, SETTLED = 12, 0.01  # most iterations of the weights of large jerks; change of all of them that ends these
FINEST = 0.25  # of the sampling interval: distance of knots where the acceleration jumps
CLOSE = 0.6  # of the resolution: how near the motion comes to a signal without noise, half of it being rounding
REACH, SAMPLES = 0.03, 2.0  # s, and sampling intervals at least, around a misfit in which the motion may bend sharply too


def smooth_within_noise(signal: Signal, start: float, stop: float, rest_before: bool, rest_after: bool) -> Piece:
    """The smoothest curve between `start` and `stop` [s] that fits the signal; see the file's first lines.

    Velocity and acceleration vanish at `start` with `rest_before` and at `stop` with `rest_after`; samples beyond those
    times count for the constant values held there.
    """
    fit = _Spline(signal, start, stop, rest_before, rest_after)
    count = int(np.clip(np.ceil((stop - start) / SPACING), 8, MOST_INTERVALS))
    breaks, weights = np.linspace(start, stop, count + 1), np.ones(count)
    first = fit.problem(breaks)
    best = minimize_scalar(lambda weight: first.solve(weight)[0], bounds=RANGE, method="bounded", options={"xatol": 0.05})
    curve = fit.curve(breaks, first.solve(best.x)[1])
    usual = float(np.sqrt(np.mean(_jerk(curve, breaks) ** 2)))
    for _ in range(ROUNDS):
        misses = (excess(signal, curve(fit.time), CLOSE) > 1.0) & fit.inside
        if not misses.any():
            break
        breaks, weights = _sharper(breaks, weights, fit.time[misses], signal.interval)
        curve = _with_jumps(fit, breaks, weights, curve, (float(best.x), first.scale, usual))
    return Piece(curve, start, stop)


def _with_jumps(fit: "_Spline", breaks: Floats, weights: Floats, curve: BSpline, given: tuple[float, float, float]) -> BSpline:
    """The spline whose jerk beyond the usual one counts in proportion to its size in intervals with a weight below 1.

    It is found by reweighting, from the `curve` before; `given` are the weight of the squared jerk, its scale and the usual jerk.
    """
    weight, scale, usual = given
    problem, shares = fit.problem(breaks, scale), np.ones(len(weights))
    for _ in range(REWEIGHTINGS):
        before = shares
        shares = np.where(weights < 1.0, 1.0 / np.maximum(np.abs(_jerk(curve, breaks)) / usual, 1.0), 1.0)
        curve = fit.curve(breaks, problem.with_roughness(fit.roughness(breaks, weights * shares)).solve(weight)[1])
        if np.all(np.abs(shares - before) <= SETTLED * before):
            break
    return curve


def _jerk(curve: BSpline, breaks: Floats) -> Floats:
    """Jerk in each interval (n,) [m/s3]."""
    return np.asarray(curve(0.5 * (breaks[1:] + breaks[:-1]), 3))


class _Spline:
    """Splines of a signal between two times with any breaks between polynomials."""

    def __init__(self, signal: Signal, start: float, stop: float, rest_before: bool, rest_after: bool) -> None:
        self.time, self.rests = np.clip(signal.time, start, stop), (rest_before, rest_after)
        self.inside = (signal.time >= start) & (signal.time <= stop)
        self.offset = float(np.mean(signal.position))
        self.position = signal.position - self.offset

    def problem(self, breaks: Floats, scale: float | None = None) -> PenalisedProblem:
        """Least squares with the squared jerk."""
        knots, tie = self._basis(breaks)
        design = csr_array(BSpline.design_matrix(self.time, knots, DEGREE)) @ tie
        return PenalisedProblem(design, self.roughness(breaks, np.ones(len(breaks) - 1)), self.position, DEGREE, scale)

    def roughness(self, breaks: Floats, weights: Floats) -> csr_array:
        """Matrix of the jerk, whose square has a weight in each interval."""
        knots, tie = self._basis(breaks)
        return csr_array(diags_array(weights**0.5) @ third_derivative(knots, DEGREE) @ tie)

    def curve(self, breaks: Floats, coefficients: Floats) -> BSpline:
        """The spline with these free coefficients."""
        knots, tie = self._basis(breaks)
        return BSpline(knots, tie @ coefficients + self.offset, DEGREE)

    def _basis(self, breaks: Floats) -> tuple[Floats, csr_array]:
        knots = np.concatenate((np.full(DEGREE, breaks[0]), breaks, np.full(DEGREE, breaks[-1])))
        return knots, end_ties(len(knots) - DEGREE - 1, *self.rests)


def _sharper(breaks: Floats, weights: Floats, times: Floats, interval: float) -> tuple[Floats, Floats]:
    """Breaks and weights with lower weights around these times, and intervals halved that are longer than the finest."""
    reach = max(REACH, SAMPLES * interval)
    first = np.searchsorted(breaks[1:], times - reach)
    after = np.searchsorted(breaks[:-1], times + reach)
    edges = np.zeros(len(weights) + 1)
    np.add.at(edges, first, 1.0)
    np.add.at(edges, after, -1.0)
    near = np.cumsum(edges)[:-1] > 0.0
    lowered = np.where(near, weights / LOWERING, weights)
    wide = np.flatnonzero(near & (np.diff(breaks) > 1.5 * FINEST * interval))
    middles = 0.5 * (breaks[wide] + breaks[wide + 1])
    return np.insert(breaks, wide + 1, middles), np.insert(lowered, wide + 1, lowered[wide])
