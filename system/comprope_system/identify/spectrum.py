"""Where in frequency a residual has its peaks: the frequencies to try for an effect that has one of its own."""

import numpy as np
from scipy.signal import find_peaks, lombscargle

from .point import Predictions
from .problem import Problem
from .replay import referred

MOST = 3
LOWEST, HIGHEST = 0.05, 3.0  # Hz


def frequencies(problem: Problem, predictions: Predictions) -> tuple[float, ...]:
    """The frequencies [Hz] of the highest peaks in the residual of the lateral channels, over all runs."""
    grid = np.linspace(LOWEST, HIGHEST, 600)
    power = np.zeros(len(grid))
    for run in problem.runs:
        measured = referred(run.values, run, problem.campaign.channels)
        for column, channel in problem.campaign.channels.items():
            left = measured[column] - predictions[run.file, column]
            known = np.isfinite(left)
            if channel.quantity == "lateral_displacement" and known.sum() > 100:
                every = max(1, int(known.sum() / 800))
                t, x = run.time[known][::every], left[known][::every]
                power += lombscargle(t, x - x.mean(), 2.0 * np.pi * grid) / max(float(np.var(x)), 1e-300)
    peaks, _ = find_peaks(power)
    highest = sorted(peaks, key=lambda k: -power[k])[:MOST]
    return tuple(round(float(grid[k]), 4) for k in highest)
