"""Measures of how a prediction differs from a measurement: in size and phase, by place, by frequency, by order of turning."""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lombscargle, periodogram

from ..settings import COMPARISON

Floats = NDArray[np.float64]
ORDERS = np.arange(*COMPARISON.orders)  # periods in one turn of the sheave


@dataclass(frozen=True)
class SpragueGeers:
    """Sprague and Geers' errors: 0 is perfect. Magnitude 0.1: 10 % too large; phase 0.1: off by a tenth of half a period."""

    magnitude: float
    phase: float

    @property
    def combined(self) -> float:
        """Both in one."""
        return float(np.hypot(self.magnitude, self.phase))


def sprague_geers(measured: Floats, predicted: Floats) -> SpragueGeers:
    """Sprague and Geers' errors (2003) of the variation about the measured mean, (n,) each, all finite.

    M = sqrt(sum p^2 / sum m^2) - 1 and P = arccos(sum m p / sqrt(sum m^2 sum p^2)) / pi.
    """
    m, p = measured - measured.mean(), predicted - measured.mean()
    mm, pp, mp = float(m @ m), float(p @ p), float(m @ p)
    if mm == 0.0 or pp == 0.0:
        return SpragueGeers(float("nan"), float("nan"))
    return SpragueGeers(float(np.sqrt(pp / mm)) - 1.0, float(np.arccos(np.clip(mp / np.sqrt(mm * pp), -1.0, 1.0)) / np.pi))


def rms(values: Floats) -> float:
    """Root mean square; NaN of nothing."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")


def by_bins(place: Floats, residual: Floats, edges: Floats) -> Floats:
    """Root mean square of `residual` in each bin of `place`; NaN where too few samples lie."""
    index = np.digitize(place, edges[1:-1])
    return np.array(
        [rms(residual[index == k]) if (index == k).sum() >= COMPARISON.min_samples else np.nan for k in range(len(edges) - 1)]
    )


def by_band(time: Floats, residual: Floats) -> Floats:
    """Root mean square of a residual (n,) at `time` [s] within each band, from its longest stretch without a gap."""
    t, x = longest_stretch(time, residual)
    if len(t) < COMPARISON.min_samples:
        return np.full(len(COMPARISON.frequency_bands) - 1, np.nan)
    even = np.linspace(t[0], t[-1], len(t))
    frequency, power = periodogram(np.interp(even, t, x), 1.0 / (even[1] - even[0]), detrend=False, scaling="spectrum")
    band = np.digitize(frequency, COMPARISON.frequency_bands[1:-1])
    return np.sqrt(np.bincount(band, power, len(COMPARISON.frequency_bands) - 1))


def longest_stretch(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """The longest part of a record without a gap of more than five sampling intervals."""
    known = np.isfinite(values)
    t, x = time[known], values[known]
    if len(t) < 2:
        return t, x
    steps = np.diff(t)
    cuts = [0, *(np.flatnonzero(steps > 5.0 * np.median(steps)) + 1), len(t)]
    first, last = max(itertools.pairwise(cuts), key=lambda pair: pair[1] - pair[0])
    return t[first:last], x[first:last]


def by_order(angle: Floats, residual: Floats, orders: Floats = ORDERS) -> Floats:
    """Amplitude of a residual (n,) at each order of turning, `angle` (n,) [rad]; NaN where it turns too little.

    An order of k is k periods in each turn: eccentricity is of order 1, a rope's strands of a high one.
    """
    if len(angle) < COMPARISON.min_samples or np.ptp(angle) < 2.0 * np.pi * COMPARISON.min_turns:
        return np.full(len(orders), np.nan)
    centred = residual - residual.mean()
    power = lombscargle(angle, centred, orders)
    return np.sqrt(4.0 * np.maximum(power, 0.0) / len(angle))
