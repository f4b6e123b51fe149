"""From raw samples to numbers that can be weighed: binned, cleaned of outliers, whitened.

Noise is taken from the campaign or, where it says nothing, from the rest before the trip; never from
the residual, which would hide what is missing. Beside the noise each channel is allowed a slow
deviation of its own, the discrepancy: what the mesh, the time step and the recovered trip leave
unsaid even when no effect is missing. It is modelled as an exponentially correlated process.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular

from .campaign import Channel, Run

Floats = NDArray[np.float64]
BIN = 0.05  # s
MOST_BINS = 500
MEMORY = 0.5  # s, correlation time of the discrepancy
SHARE = 0.002  # of a channel's rms variation: its discrepancy's standard deviation
LEAST = 0.15  # of a channel's noise: the same, at least
OUTLIER = 6.0  # standard deviations from the running median
ENOUGH = 40  # samples at rest that may contradict a stated noise


@dataclass(frozen=True)
class WhitenedChannel:
    """One channel of one run: which samples fall into which bin, and how to whiten the bins.

    `of` (samples,) is each sample's bin or -1; `factor` (bins, bins) is the lower Cholesky factor of the bins'
    covariance; `data` (bins,) the measured means; `noise` one sample's standard deviation [SI].
    """

    run: str
    column: str
    of: NDArray[np.int64]
    count: Floats
    factor: Floats
    data: Floats
    noise: float
    discrepancy: float

    def means(self, values: Floats) -> Floats:
        """Mean of `values` (samples,) in each bin."""
        used = self.of >= 0
        return np.bincount(self.of[used], np.nan_to_num(values[used]), len(self.count)) / self.count

    def whiten(self, means: Floats) -> Floats:
        """Bins' means (bins,) or (bins, k) scaled so that noise and discrepancy are white with unit variance."""
        return np.asarray(solve_triangular(self.factor, means, lower=True))


def whiten_channel(run: Run, channel: Channel, value: Floats, visible: NDArray[np.bool_]) -> WhitenedChannel | None:
    """Bin and weigh one channel of a run; None where it holds too little. `value` is referred as the channel is."""
    noise = sample_noise(run, channel, value)
    good = np.isfinite(value) & visible
    good[good] = ~outliers(value[good], noise)
    if good.sum() < 20:
        return None
    width = max(BIN, (run.time[-1] - run.time[0]) / MOST_BINS)
    index = ((run.time - run.time[0]) / width).astype(np.int64)
    used, of_good = np.unique(index[good], return_inverse=True)
    of = np.full(len(run.time), -1, np.int64)
    of[good] = of_good
    count = np.bincount(of_good).astype(float)
    discrepancy = max(SHARE * float(np.std(value[good])), LEAST * noise)
    lag = np.abs(np.subtract.outer(used, used)) * width
    covariance = discrepancy**2 * np.exp(-lag / MEMORY) + np.diag(noise**2 / count)
    if channel.reference == "rest":  # the mean at rest that was taken off is itself uncertain
        covariance += noise**2 / max(run.rest.sum(), 1)
    data = np.bincount(of_good, value[good]) / count
    return WhitenedChannel(run.file, channel.column, of, count, cholesky(covariance, lower=True), data, noise, discrepancy)


def sample_noise(run: Run, channel: Channel, value: Floats) -> float:
    """Standard deviation [SI] of one sample: as stated unless the rest before the trip contradicts that, or as seen there."""
    stated, rest = (channel.noise or 0.0) * channel.scale, value[run.rest & np.isfinite(value)]
    if stated and len(rest) < ENOUGH:
        return stated
    if stated:
        seen = spread_of_steps(rest)
        return seen if contradicted(stated, seen, len(rest)) else stated
    seen = spread_of_steps(rest if len(rest) >= 20 else value[np.isfinite(value)])
    return max(seen, 1e-9 + 1e-4 * float(np.nanstd(value)))


def spread_of_steps(value: Floats) -> float:
    """Standard deviation of white noise, from the steps between samples, so that neither drift nor outliers count."""
    steps = np.diff(value)
    return 1.4826 * float(np.median(np.abs(steps - np.median(steps)))) / 2.0**0.5


def contradicted(stated: float, seen: float, count: int) -> bool:
    """Whether a stated noise is another than that seen in `count` samples; far less than stated may be coarse digits instead."""
    margin = 1.4 * (1.0 + 2.4 / count**0.5)  # what makes a difference, and two deviations of the estimate
    return seen > margin * stated or 0.2 * stated < seen < stated / margin


def outliers(value: Floats, noise: float, window: int = 11) -> NDArray[np.bool_]:
    """Which samples are far from the median of their neighbours."""
    half = window // 2
    padded = np.pad(value, half, mode="edge")
    neighbours = np.lib.stride_tricks.sliding_window_view(padded, window)
    middle = np.median(neighbours, axis=1)
    spread = 1.4826 * np.median(np.abs(neighbours - middle[:, None]), axis=1)
    return np.asarray(np.abs(value - middle) > OUTLIER * np.maximum(spread, noise))


def stack(whitened_channels: list[WhitenedChannel], values: Mapping[tuple[str, str], Floats]) -> Floats:
    """Whitened means of all parts, one after the other; `values[(run, column)]` are in SI units per sample."""
    return np.concatenate([one.whiten(one.means(values[one.run, one.column])) for one in whitened_channels])
