"""Measured and predicted channels side by side, one run at a time: what remarks about data look at."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from ..data.campaign import Campaign
from ..data.runs import Channel, Run
from ..prediction.parameter_point import Predictions
from ..prediction.replay import relative_to_rest
from ..settings import PAIRED_RECORDS

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Record:
    """One channel of one run, measured (n,) and predicted (n,) [SI] side by side, NaN where there is none.

    `noise` [SI] is the standard deviation of one sample.
    """

    run: Run
    channel: Channel
    measured: Floats
    predicted: Floats
    noise: float

    @property
    def both(self) -> NDArray[np.bool_]:
        """Where both exist."""
        return np.isfinite(self.measured) & np.isfinite(self.predicted)

    def gain(self) -> tuple[float, float]:
        """Measured over predicted variation, and their correlation; (nan, 0) where there is too little to see."""
        both = self.both
        if both.sum() < PAIRED_RECORDS.min_samples:
            return float("nan"), 0.0
        m, p = self.measured[both] - self.measured[both].mean(), self.predicted[both] - self.predicted[both].mean()
        if np.std(m) < PAIRED_RECORDS.min_variation * self.noise or np.std(p) == 0.0:
            return float("nan"), 0.0
        return float((m @ p) / (p @ p)), float((m @ p) / np.sqrt((m @ m) * (p @ p)))


def records_of(campaign: Campaign, predictions: Predictions) -> Iterator[Record]:
    """Every channel of every run."""
    for run in campaign.runs:
        measured = relative_to_rest(run.values, run, campaign.channels)
        for column, channel in campaign.channels.items():
            yield Record(run, channel, measured[column], predictions[run.file, column], campaign.noise[column].deviation)


def by_column(records: Sequence[Record]) -> list[list[Record]]:
    """The records of each channel, over all runs."""
    ordered = sorted(records, key=lambda one: one.channel.column)
    return [list(group) for _, group in groupby(ordered, key=lambda one: one.channel.column)]
