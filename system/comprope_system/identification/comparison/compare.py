"""Residuals of the model, driven by the measured car position, for each channel: how large, and where.

Errors are normalised: root mean square of the residual over the standard deviation of the measured channel in its run, so that
those of phases, positions and frequency bands may be compared with each other and with the whole (NRMSE).
"""

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...report.json_output import plain
from ..data.campaign import Campaign
from ..data.runs import Channel, Run
from ..data.trip_phases import phases
from ..prediction.parameter_point import ParameterPoint, Predictions, collect_predictions, submit_replays
from ..prediction.replay import relative_to_rest
from ..settings import COMPARISON
from .error_metrics import ORDERS, SpragueGeers, by_band, by_bins, by_order, rms, sprague_geers
from .nrmse import moves, nrmse, overall, trusted

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ChannelComparison:
    """One channel of one run. `time` (n,) [s], `measured` and `predicted` (n,) [SI] where both exist.

    `nrmse` is `rmse` [SI] over the standard deviation of `measured`, as are the errors by phase, car position and frequency
    band; `reduced_chi_square` is the mean square of the residual over the variance of the noise; `orders` (k,) are amplitudes
    [SI] at `error_metrics.ORDERS`.
    """

    column: str
    channel: Channel
    time: Floats
    measured: Floats
    predicted: Floats
    nrmse: float
    rmse: float
    noise: float
    reduced_chi_square: float
    sprague_geers: SpragueGeers
    by_phase: dict[str, float]
    by_place: Floats
    by_band: Floats
    orders: Floats

    @property
    def residual(self) -> Floats:
        """Measured less predicted [SI]."""
        return self.measured - self.predicted

    def to_json(self) -> dict[str, Any]:
        """Everything but the series, lengths and forces in the channel's unit."""
        scale = self.channel.scale
        peaks = {f"{order:g}": float(np.interp(order, ORDERS, self.orders)) / scale for order in (0.5, 1.0, 2.0, 3.0, 4.0)}
        found = {
            "column": self.column, "unit": self.channel.unit, "nrmse": self.nrmse, "rmse": self.rmse / scale,
            "samples": len(self.time), "noise": self.noise / scale, "reduced_chi_square": self.reduced_chi_square,
            "chi_square_per_sample": self.reduced_chi_square,
            "sprague_geers": asdict(self.sprague_geers) | {"combined": self.sprague_geers.combined},
            "by_phase": self.by_phase,
            "by_car_position": list(self.by_place),
            "by_frequency": [
                {"from": a, "to": b, "nrmse": e}
                for (a, b), e in zip(pairwise(COMPARISON.frequency_bands), self.by_band, strict=True)
            ],
            "by_order": peaks,
        }  # fmt: skip
        return plain(found)


@dataclass(frozen=True)
class RunComparison:
    """One run: its channels, and the error of all of them."""

    file: str
    role: str
    channels: tuple[ChannelComparison, ...]
    nrmse: float

    def to_json(self) -> dict[str, Any]:
        """As in the contract, with more."""
        found = {"file": self.file, "role": self.role, "nrmse": self.nrmse, "channels": [one.to_json() for one in self.channels]}
        return plain(found)


@dataclass(frozen=True)
class Comparison:
    """A campaign beside its model: runs, and the NRMSE of all channels of all runs, of fit runs, and of validation runs."""

    campaign: Campaign
    predictions: Predictions
    runs: tuple[RunComparison, ...]
    nrmse: float
    fit_nrmse: float
    validate_nrmse: float

    @property
    def reduced_chi_square(self) -> float:
        """Mean over channels and runs of the reduced chi-square: near 1 the residual is explained by noise."""
        known = [one.reduced_chi_square for run in self.runs for one in run.channels if np.isfinite(one.reduced_chi_square)]
        return float(np.mean(known)) if known else float("nan")

    def noise_nrmse(self, role: str) -> float:
        """The NRMSE that the noise of the channels alone would give in the runs of a role."""
        channels = [one for run in self.runs if run.role == role for one in run.channels]
        return overall(one.noise / float(np.std(one.measured)) for one in channels if moves(one.measured))

    def to_json(self) -> dict[str, Any]:
        """As in the contract, with more; what does not exist is null."""
        height = self.campaign.model.shaft.height
        found = {
            "campaign": self.campaign.name, "runs": [one.to_json() for one in self.runs], "nrmse": self.nrmse,
            "fit_nrmse": self.fit_nrmse, "validate_nrmse": self.validate_nrmse, "reduced_chi_square": self.reduced_chi_square,
            "chi_square_per_sample": self.reduced_chi_square,
            "noise_nrmse": {"fit": self.noise_nrmse("fit"), "validate": self.noise_nrmse("validate")},
            "car_position_edges": list(np.linspace(0.0, height, COMPARISON.position_bins + 1)),
        }  # fmt: skip
        return plain(found)


def compare(
    campaign: Campaign, executor: Executor, point: ParameterPoint | None = None, known: Predictions | None = None
) -> Comparison:
    """Set every run against what was measured, replayed with the campaign's model or at another point.

    `known` are predictions there that need no replay.
    """
    files = {file for file, _ in known or {}}
    runs = [run for run in campaign.runs if run.file not in files]
    jobs = submit_replays(campaign, runs, point or ParameterPoint(), executor)
    return compared(campaign, collect_predictions(runs, jobs) | (known or {}))


def compared(campaign: Campaign, predictions: Predictions) -> Comparison:
    """The comparison of predictions for all runs."""
    runs = tuple(_run(campaign, run, predictions) for run in campaign.runs)
    by_role = {role: nrmse(campaign, campaign.of_role(role), predictions) for role in ("fit", "validate")}
    return Comparison(
        campaign, predictions, runs, nrmse(campaign, campaign.runs, predictions), by_role["fit"], by_role["validate"]
    )


def _run(campaign: Campaign, run: Run, predictions: Predictions) -> RunComparison:
    measured = relative_to_rest(run.values, run, campaign.channels)
    height = campaign.model.shaft.height
    angle = sheave_angle(campaign, run)
    channels = [
        _channel(run, channel, measured[column], predictions[run.file, column], campaign.noise[column].deviation, angle, height)
        for column, channel in campaign.channels.items()
    ]
    return RunComparison(run.file, run.role, tuple(channels), overall(one.nrmse for one in channels))


def sheave_angle(campaign: Campaign, run: Run) -> Floats:
    """Angle of the sheave since the start (n,) [rad] of a rope that does not slip, from the car's way."""
    way = run.trip.position(run.time)
    return np.asarray((way - way[0]) / campaign.model.sheave.radius)


def _channel(
    run: Run, channel: Channel, measured: Floats, predicted: Floats, noise: float, angle: Floats, height: float
) -> ChannelComparison:
    both = trusted(measured, predicted, noise)
    t, m, p = run.time[both], measured[both], predicted[both]
    if both.sum() < COMPARISON.min_samples:
        return _nothing(channel, t, m, p, noise)
    residual, variation = m - p, float(np.std(m)) if moves(m) else float("nan")
    moving = np.abs(run.trip.velocity(t)) > 0.0
    return ChannelComparison(
        column=channel.column, channel=channel, time=t, measured=m, predicted=p,
        nrmse=rms(residual) / variation, rmse=rms(residual), noise=noise,
        reduced_chi_square=float(np.mean((residual / noise) ** 2)),
        sprague_geers=sprague_geers(m, p),
        by_phase=_scaled({name: rms(residual[mask]) for name, mask in phases(run.trip, t).items()}, variation),
        by_place=by_bins(run.trip.position(t), residual, np.linspace(0.0, height, COMPARISON.position_bins + 1)) / variation,
        by_band=by_band(t, residual) / variation,
        orders=by_order(np.abs(angle[both][moving]), residual[moving]),
    )  # fmt: skip


def _nothing(channel: Channel, t: Floats, m: Floats, p: Floats, noise: float) -> ChannelComparison:
    """A channel that holds too little to say anything."""
    none, few = float("nan"), SpragueGeers(float("nan"), float("nan"))
    unknown = (np.full(count, np.nan) for count in (COMPARISON.position_bins, len(COMPARISON.frequency_bands) - 1, len(ORDERS)))
    return ChannelComparison(channel.column, channel, t, m, p, none, none, noise, none, few, {}, *unknown)


def _scaled(values: Mapping[str, float], by: float) -> dict[str, float]:
    return {name: value / by for name, value in values.items()}
