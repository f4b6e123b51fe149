"""What an unexplained residual is locked to: the clue to an effect that nobody has thought of.

The residual is what the model leaves once its plant is refitted, or the force that would explain it. Against each coordinate
a profile is taken from all runs but one and tried on that one, so that a chance likeness within a run explains nothing. A
sinusoid, in time or in the sheave's angle, may have a phase of its own in each run, since nobody knows where it began.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..comparison.compare import sheave_angle
from ..comparison.error_metrics import rms
from ..data.campaign import Campaign, Run
from ..data.trip_phases import phases
from ..prediction.parameter_point import Predictions
from ..prediction.replay import relative_to_rest
from ..settings import COMPARISON, CORRELATION

Floats = NDArray[np.float64]
FREQUENCIES = np.arange(*CORRELATION.frequencies)  # Hz
ORDERS = np.arange(*CORRELATION.orders)


@dataclass(frozen=True)
class ResidualSeries:
    """The residual of one channel in one run: `x` (n,), scaled by its rms over all runs, and coordinates (n,) beside it.

    A `floating` one is known but for its level in the run.
    """

    run: str
    column: str
    x: Floats
    at: dict[str, Floats]
    at_rest: NDArray[np.bool_]
    moving: NDArray[np.bool_]
    floating: bool = False

    def samples(self, coordinate: str) -> tuple[Floats, Floats]:
        """Coordinate and residual; where only motion tells places apart, while the car moves."""
        used = np.ones(len(self.x), bool) if coordinate in ("time", "since_start") else self.moving
        return self.at[coordinate][used], self.x[used]


@dataclass(frozen=True)
class ResidualCorrelation:
    """How much of the residual is locked to a coordinate: 0 none, 1 all; at which frequency or order, if any."""

    coordinate: str
    share: float
    unit: str
    peak: float | None = None

    def sentence(self) -> str:
        """One sentence."""
        where = f" at {self.peak:.3g} {self.unit}" if self.peak is not None else ""
        return f"{100.0 * self.share:.0f} % of the residual is locked to {self.coordinate}{where}"


def residual_correlations(campaign: Campaign, predictions: Predictions) -> list[ResidualCorrelation]:
    """What the residual is locked to, the best explanation first."""
    return correlations_of(residual_series(campaign, predictions))


def correlations_of(pieces: list[ResidualSeries]) -> list[ResidualCorrelation]:
    """What some series are locked to, of the coordinates that they have, the best explanation first."""
    if not pieces:
        return []
    found = [ResidualCorrelation(words, profile_share(pieces, name), "") for name, words in WORDS.items() if name in pieces[0].at]
    found.append(_sinusoid(pieces, "time", FREQUENCIES, 2.0 * np.pi, "a frequency", "Hz"))
    found.append(_sinusoid(pieces, "angle", ORDERS, 1.0, "the sheave's angle", "periods a turn"))
    return sorted(found, key=lambda one: -one.share)


WORDS = {
    "since_start": "time since the trip began",
    "position": "the car's position",
    "material": "one place of the rope's length",
    "velocity": "the car's velocity",
    "speed": "the car's speed, whichever way",
    "acceleration": "the car's acceleration",
    "sheave_velocity": "the sheave's vertical velocity",
}


def correlation_sentences(found: list[ResidualCorrelation], rest_ratio: float) -> list[str]:
    """Sentences for a person; `standing` is the residual's rms at rest over its rms in all."""
    clear = [one.sentence() for one in found if one.share > CORRELATION.min_share]
    still = f"at rest before the trip it is {rest_ratio:.2g} times as large as on the whole"
    none = ["it follows none of time, position, rope, speed, frequency or the sheave's angle from run to run"]
    return [*(clear or none), still] if np.isfinite(rest_ratio) else clear or none


def rest_ratio_of(campaign: Campaign, predictions: Predictions) -> float:
    """Root mean square of the residual at rest before the trip, over that of all of it; NaN where there is none."""
    pieces = residual_series(campaign, predictions)
    if not pieces:
        return float("nan")
    still, whole = np.concatenate([one.x[one.at_rest] for one in pieces]), np.concatenate([one.x for one in pieces])
    return rms(still) / rms(whole)


def residual_series(campaign: Campaign, predictions: Predictions) -> list[ResidualSeries]:
    """The residual of every channel and run beside its coordinates; channels that show only noise are left out."""
    raw = [one for run in campaign.runs for one in _series_of_run(campaign, run, predictions)]
    pieces = []
    for column, channel in campaign.channels.items():
        own = [one for one in raw if one.column == column]
        size = rms(np.concatenate([one.x for one in own])) if own else 0.0
        if size > CORRELATION.min_residual * channel.scale * (channel.noise or 0.0):
            pieces += [ResidualSeries(one.run, column, one.x / size, one.at, one.at_rest, one.moving) for one in own]
    return pieces


def _series_of_run(campaign: Campaign, run: Run, predictions: Predictions) -> Iterator[ResidualSeries]:
    measured = relative_to_rest(run.values, run, campaign.channels)
    for column in campaign.channels:
        residual = measured[column] - predictions[run.file, column]
        known = np.flatnonzero(np.isfinite(residual))
        if len(known) < CORRELATION.min_samples:
            continue
        known = known[:: max(1, len(known) // CORRELATION.max_samples)]
        t = run.time[known]
        at = motion_of(campaign, run, t) | {"material": _material(campaign, run, column, t)}
        yield ResidualSeries(
            run.file, column, residual[known], at, phases(run.trip, t)["rest"], np.abs(run.trip.velocity(t)) > 0.0
        )


def motion_of(campaign: Campaign, run: Run, t: Floats) -> dict[str, Floats]:
    """Time, the car's motion, and the sheave's angle in a run at times t (n,) [s]."""
    return {
        "time": t,
        "since_start": t - run.trip.rest_before,
        "angle": np.interp(t, run.time, sheave_angle(campaign, run)),
        "position": run.trip.position(t),
        "velocity": run.trip.velocity(t),
        "speed": np.abs(run.trip.velocity(t)),
        "acceleration": run.trip.acceleration(t),
    }


def _material(campaign: Campaign, run: Run, column: str, t: Floats) -> Floats:
    """The place of the rope that a sensor sees, from the car's end [m]."""
    model = campaign.model
    sensors = {one.name: one for one in model.sensors}
    sensor = sensors.get(campaign.channels[column].sensor or "")
    side, height = (sensor.side, sensor.height) if sensor else ("car", -model.shaft.pit)
    if side == "car":
        return np.asarray(run.trip.position(t) - height)
    return np.asarray(model.rope_length - (run.counterweight.position(t) - height))


# -- profiles ----------------------------------------------------------------------------------------


def profile_share(pieces: list[ResidualSeries], coordinate: str) -> float:
    """Share of the mean square that profiles over a coordinate explain in runs that did not make them.

    Each channel has its own profile, but for the rope's material, which passes one sensor after the other.
    """
    pooled = coordinate == "material"
    groups = (
        {"": pieces} if pooled else {column: [p for p in pieces if p.column == column] for column in {p.column for p in pieces}}
    )
    left = whole = 0.0
    for group in groups.values():
        edges = _edges(group, coordinate)
        for run in {one.run for one in group}:
            known = [one for one in group if one.run != run]
            profile = _profile(known, coordinate, edges)
            for one in (one for one in group if one.run == run):
                place, x = one.samples(coordinate)
                missed = x - profile[np.digitize(place, edges[1:-1])]
                left += float(np.sum((missed - missed.mean() if one.floating else missed) ** 2))
                whole += float(np.sum((x - x.mean() if one.floating else x) ** 2))
    return max(0.0, 1.0 - left / whole) if whole else 0.0


def _edges(group: list[ResidualSeries], coordinate: str) -> Floats:
    values = np.concatenate([[0.0], *(one.samples(coordinate)[0] for one in group)])
    return np.linspace(values.min(), values.max() + 1e-9, CORRELATION.profile_bins + 1)


def _profile(known: list[ResidualSeries], coordinate: str, edges: Floats) -> Floats:
    """Mean residual in each bin over some runs, zero where none lies."""
    if not known:
        return np.zeros(CORRELATION.profile_bins)
    places, residuals = (np.concatenate(parts) for parts in zip(*(one.samples(coordinate) for one in known), strict=True))
    index = np.digitize(places, edges[1:-1])
    return np.bincount(index, residuals, CORRELATION.profile_bins) / np.maximum(
        np.bincount(index, minlength=CORRELATION.profile_bins), 1
    )


def _sinusoid(
    pieces: list[ResidualSeries], coordinate: str, grid: Floats, radians: float, words: str, unit: str
) -> ResidualCorrelation:
    """The one frequency that explains most in all channels and runs, with a phase and an amplitude for each."""
    explained, whole = np.zeros(len(grid)), 0.0
    for place, x in (one.samples(coordinate) for one in pieces):
        if len(x) < COMPARISON.min_samples:
            continue
        span = float(np.ptp(place)) * radians / (2.0 * np.pi)
        whole += float((x**2).sum())
        explained += np.where(grid * span > CORRELATION.min_periods, _explained(place * radians, x, grid), 0.0)
    best = int(np.argmax(explained))
    return ResidualCorrelation(words, float(explained[best]) / whole if whole else 0.0, unit, float(grid[best]))


def _explained(phase: Floats, x: Floats, grid: Floats) -> Floats:
    """Sum of squares that a sinusoid and a constant take from x, for each frequency of the grid."""
    angles = np.outer(grid, phase)
    c, s = np.cos(angles), np.sin(angles)
    c, s, y = c - c.mean(1, keepdims=True), s - s.mean(1, keepdims=True), x - x.mean()
    cc, ss, cs, yc, ys = (c * c).sum(1), (s * s).sum(1), (c * s).sum(1), c @ y, s @ y
    determinant = np.maximum(cc * ss - cs * cs, 1e-9 * cc * ss + 1e-300)
    return np.asarray((ss * yc**2 + cc * ys**2 - 2.0 * cs * yc * ys) / determinant)
