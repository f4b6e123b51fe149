"""Plain errors of predictions: root-mean-square error over root-mean-square variation, per channel and over all."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..data.campaign import Campaign
from ..data.outliers import outliers
from ..data.runs import Run
from ..prediction.parameter_point import Predictions
from ..prediction.replay import relative_to_rest
from ..settings import COMPARISON

Floats = NDArray[np.float64]


def trusted(measured: Floats, predicted: Floats, noise: float) -> NDArray[np.bool_]:
    """Which samples (n,) exist in both and are measured near their neighbours; `noise` [SI] is one sample's."""
    both = np.isfinite(measured) & np.isfinite(predicted)
    both[both] = ~outliers(measured[both], noise) if both.any() else False
    return both


def channel_error(measured: Floats, predicted: Floats, noise: float) -> float:
    """Root-mean-square error over the root-mean-square variation of the measured values, of samples that are `trusted`.

    NaN for a channel that never moves.
    """
    both = trusted(measured, predicted, noise)
    if both.sum() < 2:
        return float("nan")
    error = float(np.sqrt(np.mean((measured[both] - predicted[both]) ** 2)))
    return error / float(np.std(measured[both])) if moves(measured[both]) else float("nan")


def moves(measured: Floats) -> bool:
    """Whether a channel (n,) varies at all, beyond rounding; the error of one that does not is not defined."""
    return bool(len(measured)) and float(np.ptp(measured)) > COMPARISON.rounding * float(np.max(np.abs(measured)))


def overall(errors: Iterable[float]) -> float:
    """Root-mean-square of channel errors; NaN where there is none."""
    known = [one for one in errors if np.isfinite(one)]
    return float(np.sqrt(np.mean(np.square(known)))) if known else float("nan")


def nrmse(campaign: Campaign, runs: Sequence[Run], predictions: Predictions) -> float:
    """The error of all channels of some runs."""
    found = []
    for run in runs:
        measured = relative_to_rest(run.values, run, campaign.channels)
        for column in campaign.channels:
            noise = campaign.noise[column].deviation
            found.append(channel_error(measured[column], predictions[run.file, column], noise))
    return overall(found)
