"""Frequencies to try for oscillating effects: the model's linear response to a sway over a grid, and peaks of the residual.

The spectrum of a record alone misleads: the rope oscillates at natural frequencies of its own, which change during the trip, and
beats with the excitation. In the scan each run has an amplitude and a phase of its own, and the plant is refitted beside them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks, lombscargle

from comprope.errors import SimulationError
from comprope.rope.effects import RopeModel, names_of

from ..data.runs import Channel, Run
from ..data.whitening import WhitenedChannel
from ..estimation.gauss_newton import FitResult
from ..estimation.weighted_least_squares import LeastSquaresProblem
from ..prediction.parameter_point import Predictions, run_at_point
from ..prediction.replay import relative_to_rest
from ..prediction.replay_sensitivities import replay_with_sensitivities
from ..settings import FREQUENCIES, REPLAY

Floats = NDArray[np.float64]
EFFECT = "building_sway"


def sway_frequencies(problem: LeastSquaresProblem, fitted: FitResult, coarse: float) -> tuple[float, ...]:
    """Frequencies [Hz] at which a sway explains most of the residual of a fit, on elements `coarse` times as long.

    The run of which least is explained decides.
    """
    campaign = problem.campaign
    if EFFECT not in names_of(campaign.model):
        return ()
    k = problem.worst_run(problem.residual(fitted.predictions) ** 2)
    fitted, problem = replace(fitted, jacobian=fitted.jacobian[problem.rows_of_runs[k]]), problem.of_run(k)
    grid = np.arange(FREQUENCIES.sway_lowest, FREQUENCIES.sway_highest, FREQUENCIES.sway_spacing / problem.longest)
    there = run_at_point(campaign.model, problem.runs[0], problem.with_held_fixed(fitted.point), coarse)
    channels = problem.whitened_channels
    job = problem.executor.submit(sway_responses, campaign.model, there, campaign.channels, channels, grid, coarse)
    try:
        explained = explained_squares(problem, fitted, job.result())
    except SimulationError:  # elements or time steps too long for this rope
        return ()
    peaks, _ = find_peaks(explained)
    best = sorted(peaks, key=lambda k: -explained[k])[: FREQUENCIES.sway_count]
    return tuple(round(_parabola_maximum(grid, explained, k), 4) for k in best)


def sway_responses(
    model: RopeModel,
    run: Run,
    channels: Mapping[str, Channel],
    whitened_channels: Sequence[WhitenedChannel],
    grid: Floats,
    coarse: float,
) -> Floats:
    """Whitened responses (data of the run, frequencies, 2) to the sine and the cosine of a sway of 1 m."""
    amplitude, frequency, phase = (f"effects.{EFFECT}.{name}" for name in ("amplitude", "frequency", "phase"))
    at = {f"{k}.{turn}": {frequency: float(f), phase: 0.5 * pi * turn} for k, f in enumerate(grid) for turn in (0, 1)}
    directions = {name: {amplitude: 1.0} for name in at}
    _, by = replay_with_sensitivities(model, run, channels, directions, coarse * REPLAY.time_step, at)
    columns = [np.concatenate([one.whiten(one.means(by[name][one.column])) for one in whitened_channels]) for name in at]
    return np.column_stack(columns).reshape(-1, len(grid), 2)


def explained_squares(problem: LeastSquaresProblem, fitted: FitResult, responses: Floats) -> Floats:
    """Decrease of chi-square (frequencies,) of one run by a sway of each frequency, with the plant refitted linearly."""
    others = problem.directions(fitted.hypothesis)
    plant, _ = np.linalg.qr(np.vstack([fitted.jacobian, np.diag([1.0 / one.prior for one in others])]))
    left = _orthogonal_to(plant, np.append(problem.residual(fitted.predictions), np.zeros(len(others))))
    found = []
    for k in range(responses.shape[1]):
        columns = _orthogonal_to(plant, np.vstack([responses[:, k], np.zeros((len(others), 2))]))
        solution = np.linalg.lstsq(columns.T @ columns, columns.T @ left, rcond=FREQUENCIES.sway_cutoff)[0]
        found.append(float(left @ columns @ solution))
    return np.array(found)


def residual_peak_frequencies(problem: LeastSquaresProblem, predictions: Predictions) -> tuple[float, ...]:
    """Frequencies [Hz] of the highest peaks in the Lomb-Scargle periodograms of the lateral channels' residuals, summed."""
    grid = np.linspace(FREQUENCIES.peak_lowest, FREQUENCIES.peak_highest, FREQUENCIES.peak_grid)
    power = np.zeros(len(grid))
    for run in problem.runs:
        measured = relative_to_rest(run.values, run, problem.campaign.channels)
        for column, channel in problem.campaign.channels.items():
            residual = measured[column] - predictions[run.file, column]
            known = np.isfinite(residual)
            if channel.quantity == "lateral_displacement" and known.sum() > FREQUENCIES.min_samples:
                every = max(1, int(known.sum() / FREQUENCIES.max_samples))
                t, x = run.time[known][::every], residual[known][::every]
                power += lombscargle(t, x - x.mean(), 2.0 * np.pi * grid) / max(float(np.var(x)), 1e-300)
    peaks, _ = find_peaks(power)
    highest = sorted(peaks, key=lambda k: -power[k])[: FREQUENCIES.peak_count]
    return tuple(round(float(grid[k]), 4) for k in highest)


def _parabola_maximum(grid: Floats, values: Floats, k: int) -> float:
    """Abscissa of the maximum of the parabola through a peak and its neighbours on an even grid."""
    low, top, high = values[k - 1 : k + 2]
    return float(grid[k] + 0.5 * (grid[1] - grid[0]) * (low - high) / (low - 2.0 * top + high))


def _orthogonal_to(basis: Floats, columns: Floats) -> Floats:
    """Part of the columns (n,) or (n, k) orthogonal to an orthonormal basis (n, m)."""
    return np.asarray(columns - basis @ (basis.T @ columns))
