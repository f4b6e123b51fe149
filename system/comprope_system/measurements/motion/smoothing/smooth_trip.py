"""Estimates the smooth motion of the car in a single trip from a noisy encoder signal.

A car driven by a jerk-limited controller closely follows a profile of seven phases, so that profile is
fitted first: a dozen parameters estimated from thousands of samples average out nearly all of the noise.
Deviations from the profile (lag, overshoot, creeping) are added as a smoothing spline, only if they
increase the likelihood sufficiently. A car that follows no such profile is described by the spline alone.
"""

import numpy as np
from numpy.typing import NDArray

from ..jerk_limited_profile import Fit, Guess, fit_profile, inliers
from ..signal.position_signal import Signal
from ..signal.spikes import distance_to_neighbours
from ..trip import ENDS_UNDER_WAY, Piece, Trip, continued
from .smoothing_spline import Smoothed, smooth

Floats = NDArray[np.float64]

LEVEL = 0.25  # s at either end of the record over which the median position is taken
BEFORE, AFTER = 1.0, 2.0  # s: how far a deviation from the profile may reach beyond its ends
EVIDENCE = 10.0  # decrease of -2 log likelihood from which on a spline is added to the profile


def recover_smooth_trip(signal: Signal, arrives: bool) -> Trip | None:
    """The smooth trip estimated from a signal that begins at rest; None where the car ends where it began, or moved unseen.

    Outliers are left out. `arrives`: the record ends at rest.
    """
    t, x, noise = signal.time, signal.position, signal.noise
    guess = _guess(t, x, noise)
    if guess is None:
        return None
    free = _free(t, x, noise, guess, arrives)
    if not arrives:
        return Trip(tuple(continued(piece) for piece in free[0].pieces), free[0].noise, free[0].kind, (ENDS_UNDER_WAY,))
    fit = fit_profile(t, x, noise, guess)
    shaped = _shaped(t, x, fit)
    return min((free, shaped), key=lambda candidate: candidate[1])[0]


def _guess(time: Floats, position: Floats, noise: float) -> Guess | None:
    """Initial guess of the trip, None where it ends where it began, or none is seen."""
    first = float(np.median(position[time <= time[0] + LEVEL]))
    last = float(np.median(position[time >= time[-1] - LEVEL]))
    away, back = _lasting(np.abs(position - first) > 6.0 * noise), _lasting(np.abs(position - last)[::-1] > 6.0 * noise)
    if away is None or back is None or abs(last - first) < 6.0 * noise:
        return None
    start, stop = float(time[away]), float(time[len(time) - 1 - back])
    if start >= stop:  # it moved in a gap of the record
        return None
    quarter, three = (time[np.argmax((position - first) / (last - first) > part)] for part in (0.25, 0.75))
    speed = abs(last - first) / max(2.0 * float(three - quarter), 0.1)
    return Guess(first, last - first, start, stop, speed)


def _lasting(moved: NDArray[np.bool_], count: int = 5) -> int | None:
    """Index of the first of `count` successive true values; fewer are taken for outliers."""
    runs = np.lib.stride_tricks.sliding_window_view(moved, count).all(axis=1)
    return int(np.argmax(runs)) if runs.any() else None


def _free(time: Floats, position: Floats, noise: float, guess: Guess, arrives: bool) -> tuple[Trip, float]:
    """The trip as a smoothing spline without outliers, and its -2 log likelihood."""
    start = max(guess.start - BEFORE, float(time[0]))
    stop = min(guess.stop + AFTER, float(time[-1])) if arrives else float(time[-1])
    used = _near_neighbours(time, position, noise)
    smoothed = smooth(time[used], position[used], start, stop, arrives)
    used &= inliers((position - smoothed.piece.value(time)) / noise)
    smoothed = smooth(time[used], position[used], start, stop, arrives)
    return _trip((smoothed.piece,), time[used], position[used], "spline"), smoothed.criterion


def _near_neighbours(time: Floats, position: Floats, noise: float) -> NDArray[np.bool_]:
    """Which samples are close to the median of the lines between pairs of neighbours, one to five samples away."""
    index = np.arange(len(time))
    reach_time = time[np.clip(index + 3, None, len(time) - 1)] - time[np.clip(index - 3, 0, None)]
    return distance_to_neighbours(time, position) < 8.0 * noise + 0.5 * reach_time**2


def _shaped(time: Floats, position: Floats, fit: Fit) -> tuple[Trip, float]:
    """The trip as a profile, with a spline of the residual if EVIDENCE supports it; and -2 log likelihood."""
    t, x = time[fit.used], position[fit.used]
    start, stop = max(fit.piece.start - BEFORE, float(time[0])), min(fit.piece.stop + AFTER, float(time[-1]))
    rest: Smoothed = smooth(t, x - fit.piece.value(t), start, max(stop, start + 1.0))
    price = len(fit.parameters) * float(np.log(len(t)))
    if rest.constant_criterion - rest.criterion < EVIDENCE:
        return _trip((fit.piece,), t, x, "profile"), rest.constant_criterion + price
    return _trip((fit.piece, rest.piece), t, x, "profile and spline"), rest.criterion + price


def _trip(pieces: tuple[Piece, ...], time: Floats, position: Floats, kind: str) -> Trip:
    bare = Trip(pieces, 0.0, kind)
    return Trip(pieces, float(np.std(position - bare.position(time))), kind)
