"""Plain errors of predictions: root-mean-square error over root-mean-square variation, per channel and over all."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from .campaign import Campaign, Run
from .point import Predictions
from .replay import referred

Floats = NDArray[np.float64]


def channel_error(measured: Floats, predicted: Floats) -> float:
    """Root-mean-square error over the root-mean-square variation of the measured values, where both exist."""
    both = np.isfinite(measured) & np.isfinite(predicted)
    if both.sum() < 2:
        return float("nan")
    variation = float(np.std(measured[both]))
    return float(np.sqrt(np.mean((measured[both] - predicted[both]) ** 2))) / max(variation, 1e-12)


def overall(errors: Iterable[float]) -> float:
    """Root-mean-square of channel errors; NaN where there is none."""
    known = [one for one in errors if np.isfinite(one)]
    return float(np.sqrt(np.mean(np.square(known)))) if known else float("nan")


def nrmse(campaign: Campaign, runs: Sequence[Run], predictions: Predictions) -> float:
    """The error of all channels of some runs."""
    found = []
    for run in runs:
        measured = referred(run.values, run, campaign.channels)
        found += [channel_error(measured[column], predictions[run.file, column]) for column in campaign.channels]
    return overall(found)
