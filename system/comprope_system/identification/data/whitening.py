"""Binning, outlier rejection and whitening of measured channels.

The standard deviation of the noise is stated in the campaign or estimated from the rest before the trip, never from the
residual, which would hide what is missing. Each channel is also allowed a slow model discrepancy (error of mesh, time step
and recovered trip), an exponentially correlated process. With bins of n_k samples at times t_k the covariance is

    C_jk = s_d^2 exp(-|t_j - t_k| / T) + delta_jk s^2 / n_k,    C = L L',

with the noise s and the discrepancy s_d; the whitened channel is L^-1 y. Compare Kennedy and O'Hagan (2001).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular

from ..settings import NOISE, WHITENING
from .campaign import Channel, Run

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class WhitenedChannel:
    """Bins of one channel in one run, and the factor that whitens them.

    `bin_of` (samples,) is the bin of each sample, -1 for none; `count` (bins,) the samples in each bin; `factor` (bins, bins)
    the lower Cholesky factor of the bins' covariance; `data` (bins,) the measured means [SI]; `noise` and `discrepancy` are
    standard deviations [SI] of one sample.
    """

    run: str
    column: str
    bin_of: NDArray[np.int64]
    count: Floats
    factor: Floats
    data: Floats
    noise: float
    discrepancy: float

    def means(self, values: Floats) -> Floats:
        """Mean (bins,) of `values` (samples,) in each bin."""
        used = self.bin_of >= 0
        return np.bincount(self.bin_of[used], np.nan_to_num(values[used]), len(self.count)) / self.count

    def whiten(self, means: Floats) -> Floats:
        """Means (bins,) or (bins, k) scaled so that noise and discrepancy are white with unit variance."""
        return np.asarray(solve_triangular(self.factor, means, lower=True))


def whiten_channel(run: Run, channel: Channel, value: Floats, visible: NDArray[np.bool_]) -> WhitenedChannel | None:
    """Bins and weights of a channel in a run; None with fewer than `WHITENING.min_samples` usable samples, or with equal ones.

    `value` (samples,) [SI] is relative to rest where the channel is; samples that are not `visible` (samples,) are left out.
    """
    noise = sample_noise(run, channel, value)
    good = np.isfinite(value) & visible
    good[good] = ~outliers(value[good], noise)
    if good.sum() < WHITENING.min_samples or np.ptp(value[good]) == 0.0:
        return None
    width = max(WHITENING.bin_width, (run.time[-1] - run.time[0]) / WHITENING.max_bins)
    index = ((run.time - run.time[0]) / width).astype(np.int64)
    used, bin_of_good = np.unique(index[good], return_inverse=True)
    bin_of = np.full(len(run.time), -1, np.int64)
    bin_of[good] = bin_of_good
    count = np.bincount(bin_of_good).astype(float)
    discrepancy = max(WHITENING.discrepancy_share * float(np.std(value[good])), WHITENING.discrepancy_noise * noise)
    lag = np.abs(np.subtract.outer(used, used)) * width
    covariance = discrepancy**2 * np.exp(-lag / WHITENING.discrepancy_time) + np.diag(noise**2 / count)
    if channel.reference == "rest":  # the mean at rest that was subtracted has an error of its own, common to all bins
        covariance += noise**2 / max(run.rest.sum(), 1)
    data = np.bincount(bin_of_good, value[good]) / count
    factor = cholesky(covariance, lower=True)
    return WhitenedChannel(run.file, channel.column, bin_of, count, factor, data, noise, discrepancy)


def sample_noise(run: Run, channel: Channel, value: Floats) -> float:
    """Standard deviation [SI] of the noise of one sample: as stated, unless the rest before the trip contradicts that."""
    stated, rest = (channel.noise or 0.0) * channel.scale, value[run.rest & np.isfinite(value)]
    if not np.isfinite(value).any():
        return stated or NOISE.floor
    if stated and len(rest) < NOISE.min_rest_samples:
        return stated
    if stated:
        estimated = noise_from_differences(rest)
        return estimated if is_contradicted(stated, estimated, len(rest)) else stated
    estimated = noise_from_differences(rest if len(rest) >= NOISE.min_estimate_samples else value[np.isfinite(value)])
    return max(estimated, NOISE.floor + NOISE.floor_share * float(np.nanstd(value)))


def noise_from_differences(value: Floats) -> float:
    """Standard deviation of white noise in `value` (n,), from the median absolute deviation of successive differences.

    Neither drift nor outliers contribute.
    """
    steps = np.diff(value)
    return NOISE.mad_factor * float(np.median(np.abs(steps - np.median(steps)))) / 2.0**0.5


def is_contradicted(stated: float, estimated: float, count: int) -> bool:
    """Whether an estimate from `count` samples contradicts the stated noise.

    An estimate far below the stated noise may be due to coarse quantisation and contradicts nothing.
    """
    margin = NOISE.contradiction_factor * (1.0 + NOISE.contradiction_width / count**0.5)
    return estimated > margin * stated or NOISE.quantisation_ratio * stated < estimated < stated / margin


def outliers(value: Floats, noise: float, window: int = WHITENING.outlier_window) -> NDArray[np.bool_]:
    """Samples (n,) far from the median of a `window` of neighbours, in units of their scatter or the noise (Hampel filter)."""
    if not len(value):
        return np.zeros(0, bool)
    half = window // 2
    padded = np.pad(value, half, mode="edge")
    neighbours = np.lib.stride_tricks.sliding_window_view(padded, window)
    middle = np.median(neighbours, axis=1)
    spread = NOISE.mad_factor * np.median(np.abs(neighbours - middle[:, None]), axis=1)
    return np.asarray(np.abs(value - middle) > WHITENING.outlier_threshold * np.maximum(spread, noise))


def stack(whitened_channels: list[WhitenedChannel], values: Mapping[tuple[str, str], Floats]) -> Floats:
    """Whitened means (N,) of all channels one after the other; `values[(run, column)]` (samples,) are in SI units."""
    return np.concatenate([one.whiten(one.means(values[one.run, one.column])) for one in whitened_channels])
