"""Binning, outlier rejection and whitening of measured channels.

The noise is stated in the campaign or estimated from the rests, never from the residual, which would hide what is missing.
Each channel is also allowed a slow model discrepancy (error of mesh, time step and recovered trip), an exponentially
correlated process. With bins of n_k samples at times t_k the covariance is

    C_jk = s_d^2 exp(-|t_j - t_k| / T) + (1 / n_j n_k) sum_il s_i s_l rho_(i - l) + delta_jk s_w^2,    C = L L',

with samples i of bin j and l of bin k, the noise s_i of a sample, its autocorrelation rho, the discrepancy s_d, and a small white
part s_w that keeps a strongly filtered channel from weighing its fastest changes without limit; the whitened channel is
L^-1 y. Compare Kennedy and O'Hagan (2001).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular

from ..settings import WHITENING
from .channel_noise import ChannelNoise
from .noise_model import bin_covariance
from .outliers import outliers
from .runs import Channel, Run

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class WhitenedChannel:
    """Bins of one channel in one run, and the factor that whitens them.

    `bin_of` (samples,) is the bin of each sample, -1 for none; `count` (bins,) the samples in each bin; `factor` (bins, bins)
    the lower Cholesky factor of the bins' covariance; `data` (bins,) the measured means [SI]; `noise` and `discrepancy` are
    standard deviations [SI] of one sample at rest.
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
        """Mean (bins,) of `values` (samples,) in each bin; where the rope is out of view, its nearest value in view."""
        used = self.bin_of >= 0
        return np.bincount(self.bin_of[used], _held(values)[used], len(self.count)) / self.count

    def whiten(self, means: Floats) -> Floats:
        """Means (bins,) or (bins, k) scaled so that noise and discrepancy are white with unit variance."""
        return np.asarray(solve_triangular(self.factor, means, lower=True))


def _held(values: Floats) -> Floats:
    """Values (n,) with those that are not known replaced by the nearest known one; zeros where none is.

    An effect that shifts an end's passage of a sensor hides samples that were measured; as zeros they would be off by the whole
    displacement.
    """
    known = np.isfinite(values)
    if known.all():
        return values
    return np.interp(np.arange(len(values)), np.flatnonzero(known), values[known]) if known.any() else np.zeros(len(values))


def whiten_channel(
    run: Run, channel: Channel, value: Floats, visible: NDArray[np.bool_], noise: ChannelNoise
) -> WhitenedChannel | None:
    """Bins and weights of a channel in a run; None with fewer than `WHITENING.min_samples` usable samples, or with equal ones.

    `value` (samples,) [SI] is relative to rest where the channel is; samples that are not `visible` (samples,) are left out.
    """
    good = np.isfinite(value) & visible
    good[good] = ~outliers(value[good], noise.deviation)
    if good.sum() < WHITENING.min_samples or np.ptp(value[good]) == 0.0:
        return None
    index, width = _bins(run, good)
    good &= index >= 0
    used, bin_of_good = np.unique(index[good], return_inverse=True)
    bin_of = np.full(len(run.time), -1, np.int64)
    bin_of[good] = bin_of_good
    count = np.bincount(bin_of_good).astype(float)
    spread = float(np.std(value[good]))
    discrepancy = max(WHITENING.discrepancy_share * spread, WHITENING.discrepancy_noise * noise.deviation)
    lag = np.abs(np.subtract.outer(used, used)) * width
    covariance = discrepancy**2 * np.exp(-lag / WHITENING.discrepancy_time)
    own = run.samples_of(channel.column)
    covariance += bin_covariance(bin_of[own], noise.scale(run)[own], noise.correlation)
    covariance[np.diag_indices_from(covariance)] += WHITENING.white_share * noise.deviation**2
    if channel.reference == "rest":  # the mean at rest that was subtracted has an error of its own, common to all bins
        covariance += noise.mean_variance(int((run.rest & np.isfinite(value)).sum()))
    data = np.bincount(bin_of_good, value[good]) / count
    factor = cholesky(covariance, lower=True)
    return WhitenedChannel(run.file, channel.column, bin_of, count, factor, data, noise.deviation, discrepancy)


def _bins(run: Run, good: NDArray[np.bool_]) -> tuple[NDArray[np.int64], float]:
    """The bin of each sample (samples,), -1 for none, and their width [s].

    They are no wider than a swing allows. Of a longer record, some are left out: those at rest first, and evenly of the others.
    """
    duration = float(run.time[-1] - run.time[0])
    width = min(max(WHITENING.bin_width, duration / WHITENING.max_bins), WHITENING.widest_bin)
    index = ((run.time - run.time[0]) / width).astype(np.int64)
    used = np.unique(index[good])
    if len(used) <= WHITENING.max_bins:
        return index, width
    middle = run.time[0] + (used + 0.5) * width
    moves = middle[run.trip.velocity(middle) != 0.0]
    last = np.searchsorted(moves, middle, side="right") - 1
    swings = (last >= 0) & (middle - moves[last] <= WHITENING.swing_time) if len(moves) else np.ones(len(used), bool)
    of = used[swings]
    kept = of[np.unique(np.linspace(0, len(of) - 1, min(len(of), WHITENING.max_bins)).astype(int))]
    return np.where(np.isin(index, kept), index, -1), width


def stack(whitened_channels: list[WhitenedChannel], values: Mapping[tuple[str, str], Floats]) -> Floats:
    """Whitened means (N,) of all channels one after the other; `values[(run, column)]` (samples,) are in SI units."""
    return np.concatenate([one.whiten(one.means(values[one.run, one.column])) for one in whitened_channels])
