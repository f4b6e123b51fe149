"""Noise of each channel of a campaign, from its rests in all runs, its stated deviation, its resolution and its growth in motion.

A stated deviation is the total one of a sample, and holds unless the rests contradict it; the correlation from sample to sample
always comes from the rests. A deviation that is not stated is taken at the upper 95 % limit of its estimate. Noise that grows
while the car moves (vibration) is found from what is too fast for the rope: the sixth differences of the innovations.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter
from scipy.stats import chi2

from ..settings import NOISE
from .noise_model import NoiseModel, estimate, resolution_of
from .outliers import outliers
from .runs import Channel, Run

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ChannelNoise:
    """Noise of one channel, the same in all runs.

    `deviation` [SI] is that of one sample at rest and `correlation` (lags,) the autocorrelation at 0, 1, 2 ... samples;
    `motion_factor` multiplies the deviation while the car moves; `resolution` [SI] is the step of a quantised signal, 0 for none.
    `at_rest` [SI] is the deviation that the rests show; NaN where they are too short.
    """

    deviation: float
    correlation: Floats
    motion_factor: float
    resolution: float
    at_rest: float

    def scale(self, run: Run) -> Floats:
        """Standard deviation [SI] of each sample of a run (n,)."""
        return np.where(run.moving, self.motion_factor, 1.0) * self.deviation

    def mean_variance(self, count: int) -> float:
        """Variance [SI] of the mean of `count` successive samples at rest.

        A signal that stays on one level of its resolution at rest is off by the same amount in all samples.
        """
        lags = np.arange(min(len(self.correlation), count))
        inflation = float(np.sum(np.where(lags, 2.0, 1.0) * (1.0 - lags / max(count, 1)) * self.correlation[: len(lags)]))
        held = self.at_rest < self.resolution / NOISE.dithering
        return max(self.deviation**2 * inflation / max(count, 1), self.resolution**2 / 12.0 if held else 0.0)


def channel_noise(channel: Channel, runs: Sequence[Run]) -> ChannelNoise:
    """Noise of one channel, from all runs of a campaign."""
    shown = [run for run in runs if channel.column in run.values]
    values = [run.values[channel.column] for run in shown]
    records = list(records_at_rest(channel.column, runs))
    stated = (channel.noise or 0.0) * channel.scale
    resolution = max(map(resolution_of, values), default=0.0)
    if sum(map(len, records)) < NOISE.min_rest_samples:
        deviation = stated or max(_without_rest(values), resolution / 12.0**0.5)
        return ChannelNoise(deviation, np.ones(1), 1.0, resolution, np.nan)
    model = estimate(records)
    at_rest = model.deviation
    if at_rest < resolution / 12.0**0.5:  # too little noise to pass from level to level: the rounding error is the noise
        model = NoiseModel(np.zeros(0), resolution / 12.0**0.5, model.samples)
    deviation = _deviation(stated, model, at_rest)
    floor = 0.0 if stated else NOISE.floor + NOISE.floor_share * _largest_spread(values)
    factor = _motion_factor(model, [run.values[channel.column][run.moving & run.samples_of(channel.column)] for run in shown])
    return ChannelNoise(max(deviation, floor), model.correlation, factor, resolution, at_rest)


def records_at_rest(column: str, runs: Sequence[Run]) -> Iterator[Floats]:
    """Values of a channel without gaps and outliers, before each trip, and after it where the rope hangs as still as before."""
    shown = [run for run in runs if column in run.values]
    before = [_clean(run.values[column][run.rest & run.samples_of(column)]) for run in shown]
    known = [one for one in before if len(one) >= NOISE.min_record]
    yield from known
    if not known:
        return
    still = NOISE.still_ratio * max(float(np.std(one)) for one in known)
    for run, record in zip(shown, before, strict=True):
        last = _clean(run.values[column][(run.time >= run.trip.rest_after) & run.samples_of(column)])
        half = last[len(last) // 2 :]
        if len(half) >= max(NOISE.min_record, len(record)) and float(np.std(half)) <= still:
            yield half


def _clean(values: Floats) -> Floats:
    """The longest stretch (n,) without a missing sample; outliers are replaced by the median of the others."""
    found = _longest_stretch(values).copy()
    if len(found) >= NOISE.min_record:
        far = outliers(found, spread_of_steps(found))
        found[far] = np.median(found[~far]) if not far.all() else found[far]
    return found


def _longest_stretch(values: Floats) -> Floats:
    """The longest stretch (n,) without a missing sample."""
    gaps = np.flatnonzero(~np.isfinite(np.concatenate([[np.nan], values, [np.nan]])))
    longest = int(np.argmax(np.diff(gaps)))
    return values[gaps[longest] : gaps[longest + 1] - 1]


def spread_of_steps(value: Floats, order: int = 1) -> float:
    """Standard deviation of white noise in `value` (n,), from the median absolute deviation of differences of some order.

    Neither drift nor outliers contribute, and the higher the order, the less does what is slow beside the sampling rate.
    """
    steps = np.diff(value[np.isfinite(value)], order)
    gain = comb(2 * order, order) ** 0.5
    return NOISE.mad_factor * float(np.median(np.abs(steps - np.median(steps)))) / gain if len(steps) else 0.0


def _without_rest(values: Sequence[Floats]) -> float:
    """Deviation [SI] where no rest is long enough: that of white noise, from the differences of whole runs."""
    steps = float(np.median([spread_of_steps(one, NOISE.differences) for one in values])) if values else 0.0
    return max(steps, NOISE.floor + NOISE.floor_share * _largest_spread(values))


def _largest_spread(values: Sequence[Floats]) -> float:
    """Largest standard deviation [SI] of a channel in one run."""
    return max((float(np.nanstd(one)) for one in values if np.isfinite(one).any()), default=0.0)


def _deviation(stated: float, model: NoiseModel, at_rest: float) -> float:
    """Deviation [SI]: as stated unless contradicted; else the upper limit of the estimate."""
    if stated and not is_contradicted(stated, at_rest, model.independent):
        return stated
    degrees = model.independent
    upper = model.deviation * float(np.sqrt(degrees / chi2.ppf(1.0 - NOISE.upper_limit, degrees)))
    return min(upper, NOISE.largest_upper_limit * model.deviation)


def is_contradicted(stated: float, estimated: float, independent: float) -> bool:
    """Whether an estimate from `independent` samples contradicts the stated deviation.

    An estimate far below the stated deviation may be due to coarse quantisation and contradicts nothing.
    """
    margin = NOISE.contradiction_factor * (1.0 + NOISE.contradiction_width / max(independent, 1.0) ** 0.5)
    return estimated > margin * stated or NOISE.quantisation_ratio * stated < estimated < stated / margin


def _motion_factor(model: NoiseModel, records: Sequence[Floats]) -> float:
    """Deviation while the car moves over that at rest, at least 1, from sixth differences of the innovations.

    These suppress the motion of the rope, which is slow beside the sampling rate, a million times below a tenth of that rate.
    """
    spreads, count = [], 0
    for record in records:
        if len(moving := _longest_stretch(record)) >= NOISE.min_rest_samples:
            error = lfilter(np.concatenate([[1.0], -model.coefficients]), [1.0], moving)[len(model.coefficients) :]
            fast = np.diff(error, NOISE.differences)
            spreads.append(NOISE.mad_factor * float(np.median(np.abs(fast))))
            count += len(fast)
    if not spreads or model.innovation <= 0.0:
        return 1.0
    gain = comb(2 * NOISE.differences, NOISE.differences) ** 0.5
    factor = float(np.median(spreads)) / (gain * model.innovation)
    certain = 1.0 + NOISE.factor_width * (1.0 / count + 1.0 / (2.0 * model.samples)) ** 0.5
    return factor if factor > max(certain, NOISE.least_factor) else 1.0
