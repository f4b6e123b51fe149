"""Jerk-limited profiles: seven phases of constant jerk from rest to rest, and their fit to a noisy signal."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly
from scipy.ndimage import median_filter
from scipy.optimize import least_squares

from .trip import Piece

Floats = NDArray[np.float64]

SHORTEST_RAMP = 1e-3  # s; a ramp of the acceleration takes time, or the jerk would be infinite
ENOUGH = 1000  # samples of the whole record from which the outliers are found, and the fit of all others begins
MOST_TRIALS = 150  # of a fit; a profile settles within a hundred, and a car that follows none need not be waited for
LAST_TRIALS = 10  # of the fit to all samples, which begins beside its end


def jerk_limited(origin: float, distance: float, start: float, phases: Floats) -> Piece:
    """The profile from `origin` over `distance` [m], up positive, beginning at `start` [s].

    `phases` (7,) are the durations [s] of: jerk up, constant acceleration, jerk down, constant
    speed, jerk down, constant deceleration, jerk up. Acceleration and speed follow from the distance.
    """
    jerks = _unit_jerks(phases)
    coefficients = np.zeros((4, 7))
    position = velocity = acceleration = 0.0
    for phase, (jerk, lasts) in enumerate(zip(jerks, phases, strict=True)):
        coefficients[:, phase] = jerk / 6.0, acceleration / 2.0, velocity, position
        position += lasts * (velocity + lasts * (acceleration / 2.0 + lasts * jerk / 6.0))
        velocity += lasts * (acceleration + lasts * jerk / 2.0)
        acceleration += lasts * jerk
    coefficients *= distance / position
    coefficients[3] += origin
    breaks = start + np.concatenate(([0.0], np.cumsum(phases)))
    return Piece(PPoly(coefficients, breaks), float(breaks[0]), float(breaks[-1]))


def _unit_jerks(phases: Floats) -> Floats:
    """Jerks (7,) of a profile of unit top speed."""
    up1, up2, up3, _, down1, down2, down3 = phases
    gain = 1.0 / (0.5 * up1 + up2 + 0.5 * up3)
    loss = 1.0 / (0.5 * down1 + down2 + 0.5 * down3)
    return np.array([gain / up1, 0.0, -gain / up3, 0.0, -loss / down1, 0.0, loss / down3])


@dataclass(frozen=True)
class Guess:
    """Where a trip roughly is: levels [m] at rest before and after, first and last time of motion [s], top speed [m/s]."""

    origin: float
    distance: float
    start: float
    stop: float
    speed: float


@dataclass(frozen=True)
class Fit:
    """A fitted profile, the samples used, and Schwarz's criterion of it (less is better)."""

    piece: Piece
    used: NDArray[np.bool_]
    criterion: float
    parameters: Floats


# From the fitted phases to the seven: a drive of equal limits has three different durations only.
_SYMMETRIC = np.array([0, 1, 0, 2, 0, 1, 0])
_GENERAL = np.arange(7)


def fit_profile(time: Floats, position: Floats, noise: float, guess: Guess) -> Fit:
    """The jerk-limited profile nearest to a signal of standard deviation `noise` [m], outliers left out.

    Equal limits at both ends of the trip are tried first; seven free phases are taken where the
    signal shows that they differ.
    """
    simple = _fit(time, position, noise, _SYMMETRIC, _first_parameters(guess))
    phases = simple.parameters[3:][_SYMMETRIC]
    general = _fit(time, position, noise, _GENERAL, np.concatenate((simple.parameters[:3], phases)))
    return min(simple, general, key=lambda fit: fit.criterion)


def _first_parameters(guess: Guess) -> Floats:
    cruise = abs(guess.distance) / guess.speed
    ramps = max(guess.stop - guess.start - cruise, 0.3) / 3.0
    return np.array([guess.origin, guess.distance, guess.start, ramps, ramps, max(cruise - 2.0 * ramps, 0.05)])


def _fit(time: Floats, position: Floats, noise: float, phases: NDArray[np.int_], first: Floats) -> Fit:
    lower = np.concatenate(([-np.inf] * 3, np.zeros(len(first) - 3)))
    lower[3 + phases[[0, 2, 4, 6]]] = SHORTEST_RAMP
    parameters = np.maximum(first, lower)
    thin = np.zeros(len(time), dtype=bool)
    thin[:: max(len(time) // ENOUGH, 1)] = True
    used = thin

    def residual(p: Floats) -> Floats:
        return (_shape(p, phases).value(time[used]) - position[used]) / noise

    # The first, robust pass is not drawn aside by outliers; the last one, of all samples but them, is the best fit.
    for loss, trials, last in (("soft_l1", MOST_TRIALS, False), ("linear", MOST_TRIALS, False), ("linear", LAST_TRIALS, True)):
        solution = least_squares(
            residual, parameters, bounds=(lower, np.inf), x_scale="jac", loss=loss, f_scale=3.0, max_nfev=trials
        )
        parameters = solution.x
        piece = _shape(parameters, phases)
        misfit = (position - piece.value(time)) / noise
        good = inliers(misfit)
        used = good if loss == "linear" else good & thin
        if last or (loss == "linear" and thin.all()):
            break
    criterion = used.sum() * np.log(np.mean(misfit[used] ** 2)) + len(parameters) * np.log(used.sum())
    return Fit(piece, used, float(criterion), parameters)


def _shape(parameters: Floats, phases: NDArray[np.int_]) -> Piece:
    origin, distance, start = parameters[:3]
    return jerk_limited(origin, distance, start, parameters[3:][phases])


def inliers(misfit: Floats, window: int = 31, limit: float = 5.0) -> NDArray[np.bool_]:
    """Which samples of a misfit, in standard deviations, are within `limit` of the running median."""
    running = median_filter(misfit, window, mode="mirror" if len(misfit) > window // 2 else "nearest")
    return np.abs(misfit - running) < limit
