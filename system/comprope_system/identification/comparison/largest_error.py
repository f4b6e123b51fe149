"""Where a model fails most: the run, channel and phase of the trip with the largest error beyond noise."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..data.channel_noise import ChannelNoise
from ..data.runs import Channel, Run
from ..data.trip_phases import phases
from ..settings import COMPARISON
from .compare import ChannelComparison, Comparison


@dataclass(frozen=True)
class LargestError:
    """RMS error `rms` [SI] of a channel in a phase of a run, `share` of the channel's standard deviation in that run.

    `peak` [SI] is the largest residual in that phase, at `peak_time` [s].
    """

    file: str
    role: str
    channel: Channel
    phase: str
    rms: float
    share: float
    peak: float
    peak_time: float

    def to_json(self) -> dict[str, Any]:
        """Everything, errors in the unit of the channel."""
        scale = self.channel.scale
        return {
            "file": self.file, "role": self.role, "column": self.channel.column, "phase": self.phase, "unit": self.channel.unit,
            "rmse": self.rms / scale, "nrmse": self.share, "largest": self.peak / scale, "time": self.peak_time,
        }  # fmt: skip


def largest_error(comparison: Comparison) -> LargestError | None:
    """The largest error by phase, as a share of the channel's standard deviation; None where noise explains every one."""
    runs = {run.file: run for run in comparison.campaign.runs}
    found: list[LargestError] = []
    for run in comparison.runs:
        for one in run.channels:
            found += _beyond_noise(runs[run.file], one, comparison.campaign.noise[one.column])
    return max(found, key=lambda one: one.share, default=None)


def _beyond_noise(run: Run, one: ChannelComparison, noise: ChannelNoise) -> list[LargestError]:
    """Errors of a channel in the phases whose residual is larger than chance makes that of its noise."""
    scaled = one.residual / np.interp(one.time, run.time, noise.scale(run))
    dependent = 2.0 * float(np.sum(noise.correlation**2)) - 1.0  # successive samples for each independent square
    found = []
    for name, mask in phases(run.trip, one.time).items() if np.isfinite(one.nrmse) else ():
        count = int(mask.sum())
        limit = COMPARISON.adequate + COMPARISON.chance * (2.0 * dependent / max(count, 1)) ** 0.5
        if count < COMPARISON.min_samples or np.mean(scaled[mask] ** 2) < limit:
            continue
        worst = int(np.argmax(np.where(mask, np.abs(one.residual), -1.0)))
        rms, share = one.by_phase[name] * one.rmse / one.nrmse, one.by_phase[name]
        peak, when = float(abs(one.residual[worst])), float(one.time[worst])
        found.append(LargestError(run.file, run.role, one.channel, name, rms, share, peak, when))
    return found
