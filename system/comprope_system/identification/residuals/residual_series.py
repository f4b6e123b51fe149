"""Residuals of channels, and estimated forces, as series over coordinates: time, motion of car and sheave, rope position."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..comparison.compare import sheave_angle
from ..comparison.error_metrics import rms
from ..data.campaign import Campaign
from ..data.runs import Run
from ..data.trip_phases import phases
from ..prediction.parameter_point import Predictions
from ..prediction.replay import relative_to_rest
from ..settings import CORRELATION

Floats = NDArray[np.float64]
TIMES = ("time", "since_start")


@dataclass(frozen=True)
class ResidualSeries:
    """Series of one channel in one run: `x` (n,), over its rms in all runs, with coordinates (n,) by name.

    `at_rest` (n,) are the samples before the trip, `moving` (n,) those with a moving car. The mean of a `floating` series is
    unknown in each run.
    """

    run: str
    column: str
    x: Floats
    at: dict[str, Floats]
    at_rest: NDArray[np.bool_]
    moving: NDArray[np.bool_]
    floating: bool = False

    def samples(self, coordinate: str) -> tuple[Floats, Floats]:
        """Coordinate and series; except over time only while the car moves."""
        used = np.ones(len(self.x), bool) if coordinate in TIMES else self.moving
        return self.at[coordinate][used], self.x[used]


def residual_series(campaign: Campaign, predictions: Predictions) -> list[ResidualSeries]:
    """Residuals of all channels and runs, each over its rms; channels whose residual is noise are left out."""
    unscaled = [one for run in campaign.runs for one in _series_of_run(campaign, run, predictions)]
    series = []
    for column, channel in campaign.channels.items():
        own = [one for one in unscaled if one.column == column]
        size = rms(np.concatenate([one.x for one in own])) if own else 0.0
        if size > CORRELATION.min_residual * channel.scale * (channel.noise or 0.0):
            series += [ResidualSeries(one.run, column, one.x / size, one.at, one.at_rest, one.moving) for one in own]
    return series


def rest_ratio_of(campaign: Campaign, predictions: Predictions) -> float:
    """Rms of the residual at rest before the trip over its rms in all; NaN where no residual exceeds noise."""
    series = residual_series(campaign, predictions)
    if not series:
        return float("nan")
    at_rest, everything = np.concatenate([one.x[one.at_rest] for one in series]), np.concatenate([one.x for one in series])
    return rms(at_rest) / rms(everything)


def motion_coordinates(campaign: Campaign, run: Run, t: Floats) -> dict[str, Floats]:
    """Time, motion of the car and angle of the sheave in a run at times t (n,) [s], in SI units."""
    return {
        "time": t,
        "since_start": t - run.trip.rest_before,
        "angle": np.interp(t, run.time, sheave_angle(campaign, run)),
        "position": run.trip.position(t),
        "velocity": run.trip.velocity(t),
        "speed": np.abs(run.trip.velocity(t)),
        "acceleration": run.trip.acceleration(t),
    }


def _series_of_run(campaign: Campaign, run: Run, predictions: Predictions) -> Iterator[ResidualSeries]:
    """Residuals [SI] of the channels of one run, thinned to about `CORRELATION.max_samples`."""
    measured = relative_to_rest(run.values, run, campaign.channels)
    for column in campaign.channels:
        residual = measured[column] - predictions[run.file, column]
        known = np.flatnonzero(np.isfinite(residual))
        if len(known) < CORRELATION.min_samples:
            continue
        known = known[:: max(1, len(known) // CORRELATION.max_samples)]
        t = run.time[known]
        at = motion_coordinates(campaign, run, t) | {"material": _rope_coordinate(campaign, run, column, t)}
        moving = np.abs(run.trip.velocity(t)) > 0.0
        yield ResidualSeries(run.file, column, residual[known], at, phases(run.trip, t)["rest"], moving)


def _rope_coordinate(campaign: Campaign, run: Run, column: str, t: Floats) -> Floats:
    """Arc length (n,) [m] from the car's end of the point of the rope that is at a channel's sensor."""
    model = campaign.model
    sensors = {one.name: one for one in model.sensors}
    sensor = sensors.get(campaign.channels[column].sensor or "")
    side, height = (sensor.side, sensor.height) if sensor else ("car", -model.shaft.pit)
    if side == "car":
        return np.asarray(run.trip.position(t) - height)
    return np.asarray(model.rope_length - (run.counterweight.position(t) - height))
