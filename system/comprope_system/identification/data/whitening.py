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

from ..settings import NOISE, WHITENING
from .campaign import Channel, Run

Floats = NDArray[np.float64]


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
    if good.sum() < WHITENING.min_samples:
        return None
    width = max(WHITENING.bin_width, (run.time[-1] - run.time[0]) / WHITENING.max_bins)
    index = ((run.time - run.time[0]) / width).astype(np.int64)
    used, of_good = np.unique(index[good], return_inverse=True)
    of = np.full(len(run.time), -1, np.int64)
    of[good] = of_good
    count = np.bincount(of_good).astype(float)
    discrepancy = max(WHITENING.discrepancy_share * float(np.std(value[good])), WHITENING.discrepancy_noise * noise)
    lag = np.abs(np.subtract.outer(used, used)) * width
    covariance = discrepancy**2 * np.exp(-lag / WHITENING.discrepancy_time) + np.diag(noise**2 / count)
    if channel.reference == "rest":  # the mean at rest that was taken off is itself uncertain
        covariance += noise**2 / max(run.rest.sum(), 1)
    data = np.bincount(of_good, value[good]) / count
    return WhitenedChannel(run.file, channel.column, of, count, cholesky(covariance, lower=True), data, noise, discrepancy)


def sample_noise(run: Run, channel: Channel, value: Floats) -> float:
    """Standard deviation [SI] of one sample: as stated unless the rest before the trip contradicts that, or as seen there."""
    stated, rest = (channel.noise or 0.0) * channel.scale, value[run.rest & np.isfinite(value)]
    if stated and len(rest) < NOISE.min_rest_samples:
        return stated
    if stated:
        seen = spread_of_steps(rest)
        return seen if contradicted(stated, seen, len(rest)) else stated
    seen = spread_of_steps(rest if len(rest) >= NOISE.min_estimate_samples else value[np.isfinite(value)])
    return max(seen, NOISE.floor + NOISE.floor_share * float(np.nanstd(value)))


def spread_of_steps(value: Floats) -> float:
    """Standard deviation of white noise, from the steps between samples, so that neither drift nor outliers count."""
    steps = np.diff(value)
    return NOISE.mad_factor * float(np.median(np.abs(steps - np.median(steps)))) / 2.0**0.5


def contradicted(stated: float, seen: float, count: int) -> bool:
    """Whether a stated noise is another than that seen in `count` samples; far less than stated may be coarse digits instead."""
    margin = NOISE.contradiction_factor * (
        1.0 + NOISE.contradiction_width / count**0.5
    )  # what makes a difference, and two deviations of the estimate
    return seen > margin * stated or NOISE.quantisation_ratio * stated < seen < stated / margin


def outliers(value: Floats, noise: float, window: int = WHITENING.outlier_window) -> NDArray[np.bool_]:
    """Which samples are far from the median of their neighbours."""
    half = window // 2
    padded = np.pad(value, half, mode="edge")
    neighbours = np.lib.stride_tricks.sliding_window_view(padded, window)
    middle = np.median(neighbours, axis=1)
    spread = NOISE.mad_factor * np.median(np.abs(neighbours - middle[:, None]), axis=1)
    return np.asarray(np.abs(value - middle) > WHITENING.outlier_threshold * np.maximum(spread, noise))


def stack(whitened_channels: list[WhitenedChannel], values: Mapping[tuple[str, str], Floats]) -> Floats:
    """Whitened means of all parts, one after the other; `values[(run, column)]` are in SI units per sample."""
    return np.concatenate([one.whiten(one.means(values[one.run, one.column])) for one in whitened_channels])
