"""Which frequencies a swaying building would have: the model's linear response over a grid of them.

A record's spectrum alone misleads: the rope rings at frequencies of its own, which change on the way, and beats with what
drives it. Here each run has an amplitude and a phase of its own, and the plant is refitted beside them.
"""

from collections.abc import Mapping, Sequence
from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks, lombscargle

from comprope.errors import SimulationError
from comprope.rope.effects import RopeModel, names_of

from ..data.campaign import Channel, Run
from ..data.whitening import WhitenedChannel
from ..estimation.gauss_newton import FitResult
from ..estimation.linearisation import fit_directions
from ..estimation.weighted_least_squares import LeastSquaresProblem
from ..prediction.parameter_point import Predictions, run_at_point
from ..prediction.replay import relative_to_rest
from ..prediction.replay_sensitivities import replay_with_sensitivities
from ..settings import FREQUENCIES, REPLAY

Floats = NDArray[np.float64]
EFFECT = "building_sway"


def sway_frequencies(problem: LeastSquaresProblem, fitted: FitResult, coarse: float) -> tuple[float, ...]:
    """The frequencies [Hz] at which a sway would explain most of what a fit leaves, on elements `coarse` times as long."""
    campaign = problem.campaign
    if EFFECT not in names_of(campaign.model):
        return ()
    grid = np.arange(FREQUENCIES.sway_lowest, FREQUENCIES.sway_highest, FREQUENCIES.sway_spacing / problem.longest)
    jobs = []
    for run in problem.runs:
        there = run_at_point(campaign.model, run, problem.with_held_fixed(fitted.point), coarse)
        whitened_channels = [one for one in problem.whitened_channels if one.run == run.file]
        jobs.append(problem.executor.submit(responses, campaign.model, there, campaign.channels, whitened_channels, grid, coarse))
    try:
        found = explained(problem, fitted, [job.result() for job in jobs])
    except SimulationError:  # elements or steps too long for this rope
        return ()
    peaks, _ = find_peaks(found)
    return tuple(round(_top(grid, found, k), 4) for k in sorted(peaks, key=lambda k: -found[k])[: FREQUENCIES.sway_count])


def _top(grid: Floats, found: Floats, k: int) -> float:
    """Where a parabola through a peak and its neighbours is highest."""
    low, top, high = found[k - 1 : k + 2]
    return float(grid[k] + 0.5 * (grid[1] - grid[0]) * (low - high) / (low - 2.0 * top + high))


def responses(
    model: RopeModel,
    run: Run,
    channels: Mapping[str, Channel],
    whitened_channels: Sequence[WhitenedChannel],
    grid: Floats,
    coarse: float,
) -> Floats:
    """Whitened responses (data of the run, frequencies, 2) to a sway of 1 m, as its sine and its cosine."""
    amplitude, frequency, phase = (f"effects.{EFFECT}.{name}" for name in ("amplitude", "frequency", "phase"))
    at = {f"{k}.{turn}": {frequency: float(f), phase: 0.5 * pi * turn} for k, f in enumerate(grid) for turn in (0, 1)}
    directions = {name: {amplitude: 1.0} for name in at}
    _, by = replay_with_sensitivities(model, run, channels, directions, coarse * REPLAY.time_step, at)
    columns = [np.concatenate([one.whiten(one.means(by[name][one.column])) for one in whitened_channels]) for name in at]
    return np.column_stack(columns).reshape(-1, len(grid), 2)


def explained(problem: LeastSquaresProblem, fitted: FitResult, responses: Sequence[Floats]) -> Floats:
    """How much of the squares that a fit leaves a sway of each frequency takes away (frequencies,)."""
    others, count = fit_directions(fitted.hypothesis), len(problem.data)
    plant, _ = np.linalg.qr(np.vstack([fitted.jacobian, np.diag([1.0 / one.prior for one in others])]))
    left = _orthogonal_to(plant, np.append(problem.residual(fitted.predictions), np.zeros(len(others))))
    found = []
    for k in range(responses[0].shape[1]):
        columns = np.zeros((count + len(others), 2 * len(responses)))
        for j, (rows, of_run) in enumerate(zip(problem.rows_of_runs, responses, strict=True)):
            columns[:count][rows, 2 * j : 2 * j + 2] = of_run[:, k]
        columns = _orthogonal_to(plant, columns)
        found.append(
            float(left @ columns @ np.linalg.lstsq(columns.T @ columns, columns.T @ left, rcond=FREQUENCIES.sway_cutoff)[0])
        )
    return np.array(found)


def _orthogonal_to(plant: Floats, columns: Floats) -> Floats:
    """What of some columns an orthonormal basis `plant` cannot imitate."""
    return np.asarray(columns - plant @ (plant.T @ columns))


def residual_peak_frequencies(problem: LeastSquaresProblem, predictions: Predictions) -> tuple[float, ...]:
    """The frequencies [Hz] of the highest peaks in the residual of the lateral channels, over all runs."""
    grid = np.linspace(FREQUENCIES.peak_lowest, FREQUENCIES.peak_highest, FREQUENCIES.peak_grid)
    power = np.zeros(len(grid))
    for run in problem.runs:
        measured = relative_to_rest(run.values, run, problem.campaign.channels)
        for column, channel in problem.campaign.channels.items():
            left = measured[column] - predictions[run.file, column]
            known = np.isfinite(left)
            if channel.quantity == "lateral_displacement" and known.sum() > FREQUENCIES.min_samples:
                every = max(1, int(known.sum() / FREQUENCIES.max_samples))
                t, x = run.time[known][::every], left[known][::every]
                power += lombscargle(t, x - x.mean(), 2.0 * np.pi * grid) / max(float(np.var(x)), 1e-300)
    peaks, _ = find_peaks(power)
    highest = sorted(peaks, key=lambda k: -power[k])[: FREQUENCIES.peak_count]
    return tuple(round(float(grid[k]), 4) for k in highest)
