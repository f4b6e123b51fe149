"""Correlation of the residual with coordinates: an indication of an effect that is outside the library.

The residual is that of the fitted plant, or the force that would explain it. The profile over each coordinate is the mean in
bins over all runs but one, applied to that run (leave-one-out cross-validation), so that a similarity within one run explains
nothing. A sinusoid in time or in the sheave's angle may have its own phase in each run, since the phase at the start is unknown.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..data.campaign import Campaign
from ..prediction.parameter_point import Predictions
from ..settings import COMPARISON, CORRELATION
from .residual_series import ResidualSeries, residual_series

Floats = NDArray[np.float64]
FREQUENCIES = np.arange(*CORRELATION.frequencies)
ORDERS = np.arange(*CORRELATION.orders)
COORDINATES = {
    "since_start": "time since the trip began",
    "position": "the car's position",
    "material": "one place of the rope's length",
    "velocity": "the car's velocity",
    "speed": "the car's speed, whichever way",
    "acceleration": "the car's acceleration",
    "sheave_velocity": "the sheave's vertical velocity",
}


@dataclass(frozen=True)
class ResidualCorrelation:
    """Share of the residual's mean square, 0 to 1, that a coordinate explains; `peak` is the frequency or order, if any."""

    coordinate: str
    share: float
    unit: str
    peak: float | None = None

    def sentence(self) -> str:
        """The correlation in one sentence."""
        where = f" at {self.peak:.3g} {self.unit}" if self.peak is not None else ""
        return f"{100.0 * self.share:.0f} % of the residual correlates with {self.coordinate}{where}"


def residual_correlations(campaign: Campaign, predictions: Predictions) -> list[ResidualCorrelation]:
    """Correlations of the residual with all coordinates, largest share first."""
    return correlations_of(residual_series(campaign, predictions))


def correlations_of(series: list[ResidualSeries]) -> list[ResidualCorrelation]:
    """Correlations of some series with the coordinates that they have, largest share first."""
    if not series:
        return []
    found = [
        ResidualCorrelation(words, profile_share(series, name), "") for name, words in COORDINATES.items() if name in series[0].at
    ]
    found.append(_sinusoid(series, "time", "a frequency"))
    found.append(_sinusoid(series, "angle", "the sheave's angle"))
    return sorted(found, key=lambda one: -one.share)


def correlation_sentences(found: list[ResidualCorrelation], rest_ratio: float) -> list[str]:
    """Sentences about the clear correlations and the residual at rest; `rest_ratio` as by `rest_ratio_of`."""
    clear = [one.sentence() for one in found if one.share > CORRELATION.min_share]
    at_rest = f"at rest before the trip its rms is {rest_ratio:.2g} of that of the whole record"
    none = ["it correlates with none of time, position, rope, speed, frequency or the sheave's angle from run to run"]
    return [*(clear or none), at_rest] if np.isfinite(rest_ratio) else clear or none


def profile_share(series: list[ResidualSeries], coordinate: str) -> float:
    """Share of the mean square in each run that the profile of the other runs explains.

    Each channel has a profile of its own, except over the rope's length, whose points pass one sensor after another.
    """
    columns = dict.fromkeys(one.column for one in series)
    pooled = coordinate == "material"
    groups = [series] if pooled else [[one for one in series if one.column == column] for column in columns]
    left = total = 0.0
    for group in groups:
        edges = _bin_edges(group, coordinate)
        for run in dict.fromkeys(one.run for one in group):
            profile = _profile([one for one in group if one.run != run], coordinate, edges)
            for one in (one for one in group if one.run == run):
                place, x = one.samples(coordinate)
                error = x - profile[np.digitize(place, edges[1:-1])]
                left += float(np.sum((error - error.mean() if one.floating else error) ** 2))
                total += float(np.sum((x - x.mean() if one.floating else x) ** 2))
    return max(0.0, 1.0 - left / total) if total else 0.0


def _bin_edges(group: list[ResidualSeries], coordinate: str) -> Floats:
    """Edges (bins + 1,) of even bins over the range of a coordinate, zero included."""
    values = np.concatenate([[0.0], *(one.samples(coordinate)[0] for one in group)])
    return np.linspace(values.min(), values.max() + 1e-9, CORRELATION.profile_bins + 1)


def _profile(known: list[ResidualSeries], coordinate: str, edges: Floats) -> Floats:
    """Mean (bins,) of some series in each bin, zero in empty bins."""
    bins = CORRELATION.profile_bins
    if not known:
        return np.zeros(bins)
    places, residuals = (np.concatenate(values) for values in zip(*(one.samples(coordinate) for one in known), strict=True))
    index = np.digitize(places, edges[1:-1])
    return np.bincount(index, residuals, bins) / np.maximum(np.bincount(index, minlength=bins), 1)


def _sinusoid(series: list[ResidualSeries], coordinate: str, words: str) -> ResidualCorrelation:
    """The one frequency [Hz], or order of the sheave's rotation, that explains most in all series.

    Each series has a phase and an amplitude of its own.
    """
    turns = coordinate == "angle"
    grid, radians, unit = (ORDERS, 1.0, "periods a turn") if turns else (FREQUENCIES, 2.0 * np.pi, "Hz")
    explained, total = np.zeros(len(grid)), 0.0
    for place, x in (one.samples(coordinate) for one in series):
        if len(x) < COMPARISON.min_samples:
            continue
        periods = float(np.ptp(place)) * radians / (2.0 * np.pi)
        total += float((x**2).sum())
        explained += np.where(grid * periods > CORRELATION.min_periods, explained_squares(place * radians, x, grid), 0.0)
    best = int(np.argmax(explained))
    return ResidualCorrelation(words, float(explained[best]) / total if total else 0.0, unit, float(grid[best]))


def explained_squares(phase: Floats, x: Floats, grid: Floats) -> Floats:
    """Sum of squares of x (n,) that a sinusoid beside a constant explains, for each frequency of the grid.

    `phase` (n,) [rad] is that of frequency 1. Least squares with a cosine and a sine, both centred.
    """
    angles = np.outer(grid, phase)
    c, s = np.cos(angles), np.sin(angles)
    c, s, y = c - c.mean(1, keepdims=True), s - s.mean(1, keepdims=True), x - x.mean()
    cc, ss, cs, yc, ys = (c * c).sum(1), (s * s).sum(1), (c * s).sum(1), c @ y, s @ y
    determinant = np.maximum(cc * ss - cs * cs, 1e-9 * cc * ss + 1e-300)
    return np.asarray((ss * yc**2 + cc * ys**2 - 2.0 * cs * yc * ys) / determinant)
