"""Whether a recovered motion agrees with the signal within its noise, at every place of the record."""

import numpy as np
from numpy.typing import NDArray

from .position_signal import LEAST_NOISE, Signal

Floats = NDArray[np.float64]

WINDOWS = (1, 3, 9)  # samples over which the misfit is averaged: a motion missed for a moment, or by little for longer
SURE = 6.0  # standard errors of such an average that noise does not reach in a record of a million samples, even if estimated low
TYPICAL = 8.0  # times by which averages of noise may exceed those of white noise: filtered signals
ROUNDING = 1.0  # of the resolution: rounding itself is half of it, and equal for many samples of a slow signal


def excess(signal: Signal, position: Floats, rounding: float = ROUNDING) -> Floats:
    """Misfit (n,) between `position` (n,) [m] and the signal over what its noise allows; above 1 the motion does not fit.

    The largest over windows of several lengths that contain the sample. What noise allows is taken from the noise of
    the signal, or from the usual size of such averages, if the noise is correlated. A signal without noise allows the share
    `rounding` of its resolution.
    """
    residual = signal.position - position
    least = max(rounding * signal.resolution, SURE * LEAST_NOISE)
    if signal.rounded:
        return np.asarray(np.abs(residual) / least)
    worst = np.zeros(len(residual))
    for count in (one for one in WINDOWS if one <= len(residual)):
        means = np.abs(_means(residual, count))
        white = np.sqrt(_means(signal.local_noise**2, count) / count)
        usual = float(np.clip(1.4826 * np.median(means / white), 1.0, TYPICAL))
        over = means / np.maximum(SURE * usual * white, least)
        for shift in range(count):
            part = worst[shift : shift + len(over)]
            np.maximum(part, over, out=part)
    return worst


def _means(values: Floats, count: int) -> Floats:
    """Means (n - count + 1,) of `count` successive values."""
    sums = np.cumsum(np.concatenate(([0.0], values)))
    return np.asarray((sums[count:] - sums[:-count]) / count)
