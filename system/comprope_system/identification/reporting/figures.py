"""Pictures of comparison, diagnosis and added effects."""

import itertools
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...report.plot_style import COLOURS, FIRST, GREY, SECOND, THIRD, label, legend, panels, plain
from ..comparison.compare import ChannelComparison, Comparison, RunComparison
from ..comparison.error_metrics import ORDERS
from ..data.campaign import Campaign
from ..data.trip_phases import phases
from ..residuals.input_estimation import InputEstimation
from ..residuals.residual_correlation import ResidualCorrelation
from ..settings import COMPARISON

Floats = NDArray[np.float64]
MEASURED, PHASE = SECOND, "#eef2f6"
KIND_OF_INPUT = {"N": "force", "N.m": "torque", "N/m": "line load", "m": "displacement"}  # by its unit


def overlay(campaign: Campaign, run: RunComparison, others: Mapping[str, RunComparison] | None = None) -> Figure:
    """Measured and simulated channels on the left, residuals on the right; `others` are further models of the same run."""
    shown = [one for one in run.channels if len(one.time)]
    figure, axes = panels(2, max(len(shown), 1), 1.9)
    figure.set_size_inches(12.0, 2.0 * max(len(shown), 1) + 0.3)
    models = {"model": run} if others is None else dict(others)
    for k, one in enumerate(shown):
        left, right = axes[2 * k], axes[2 * k + 1]
        scale = one.channel.scale
        left.plot(one.time, one.measured / scale, color=MEASURED, linewidth=0.9, label="measured")
        for (name, model), colour in zip(models.items(), (GREY, FIRST) if others else (FIRST,), strict=False):
            same = next(c for c in model.channels if c.column == one.column)
            left.plot(same.time, same.predicted / scale, color=colour, linewidth=1.0, label=name)
            right.plot(same.time, same.residual / scale, color=colour, linewidth=0.8, label=name)
        right.axhspan(-2.0 * one.noise / scale, 2.0 * one.noise / scale, color=THIRD, alpha=0.25, linewidth=0)
        for panel in (left, right):
            _shade(panel, campaign, run, one)
        label(left, "time [s]" if k == len(shown) - 1 else "", f"{one.column} [{one.channel.unit}]")
        label(right, "time [s]" if k == len(shown) - 1 else "", "residual")
    if shown:
        legend(axes[0], ncols=3, loc="best")
        axes[1].set_title("measured less simulated; green: ± 2 standard deviations of the noise", loc="left", fontsize=9.5)
    return figure


def _shade(axes: Axes, campaign: Campaign, run: RunComparison, one: ChannelComparison) -> None:
    """Shaded where the car accelerates or decelerates."""
    trip = next(other.trip for other in campaign.runs if other.file == run.file)
    axes.set_xlim(one.time[0], one.time[-1])
    for name in ("acceleration", "deceleration"):
        when = one.time[phases(trip, one.time)[name]]
        if len(when):
            axes.axvspan(when[0], when[-1], color=PHASE, zorder=0)


def by_position_and_frequency(comparison: Comparison) -> Figure:
    """NRMSE of each channel over car position and over frequency, root mean square over the runs."""
    figure, (left, right) = panels(2, height=3.2)
    edges = np.linspace(0.0, comparison.campaign.model.shaft.height, COMPARISON.position_bins + 1)
    bands = [f"{a:g}–{b:g}" if np.isfinite(b) else f"over {a:g}" for a, b in itertools.pairwise(COMPARISON.frequency_bands)]
    for k, column in enumerate(comparison.campaign.channels):
        own = [one for run in comparison.runs for one in run.channels if one.column == column]
        left.stairs(
            100.0 * _mean([one.by_place for one in own]), edges, color=COLOURS[k % len(COLOURS)], linewidth=1.4,
            label=plain(column),
        )
        right.plot(bands, 100.0 * _mean([one.by_band for one in own]), "o-", color=COLOURS[k % len(COLOURS)], markersize=4)
    label(left, "car position [m]", "NRMSE [%]")
    label(right, "frequency [Hz]", "")
    right.tick_params(axis="x", labelsize=8)
    legend(left)
    return figure


def _mean(rows: Sequence[Floats]) -> Floats:
    """Root mean square over rows, NaN left out."""
    squares = np.square(np.array(rows, float))
    known = np.isfinite(squares)
    return np.asarray(np.sqrt(np.where(known, squares, 0.0).sum(0) / np.where(known.any(0), known.sum(0), np.nan)))


def orders(comparison: Comparison) -> Figure:
    """Order spectrum of the residual, a panel for each channel; whole orders are multiples of the sheave's rotation."""
    columns = list(comparison.campaign.channels)
    rows = -(-len(columns) // 2)
    figure, axes = panels(2, rows, 2.4)
    for axis, column in zip(axes, columns, strict=False):
        for k, run in enumerate(comparison.runs):
            one = next(c for c in run.channels if c.column == column)
            axis.plot(ORDERS, one.orders / one.channel.scale, color=COLOURS[k % len(COLOURS)], label=plain(run.file))
        for whole in range(1, 7):
            axis.axvline(whole, color=GREY, linewidth=0.6, linestyle=":")
        label(axis, "periods per revolution of the sheave", f"{column} [{comparison.campaign.channels[column].unit}]")
    for axis in axes[len(columns) :]:
        axis.set_visible(False)
    legend(axes[0])
    return figure


def ranking(entries: Sequence[Mapping[str, float]], names: Sequence[str], plant: tuple[float, float]) -> Figure:
    """Probability of each effect, and NRMSE with it on fit and validation runs; lines: without any effect."""
    figure, (left, right) = panels(2, height=0.34 * len(names) + 1.1)
    places = np.arange(len(names))[::-1]
    left.barh(places, [one["probability"] for one in entries], color=FIRST, height=0.6)
    left.set_yticks(places, list(map(plain, names)))
    left.set_xlim(0.0, 1.0)
    for axes in (left, right):
        axes.set_ylim(-0.6, len(names) - 0.4)
    right.plot([100.0 * one["error_after"] for one in entries], places, "o", color=FIRST, label="fit runs")
    right.plot(
        [100.0 * one["validate_error_after"] for one in entries], places, "D", color=SECOND, markersize=5, label="validation runs"
    )
    for value, colour in zip(plant, (FIRST, SECOND), strict=True):
        right.axvline(100.0 * value, color=colour, linewidth=0.9, linestyle="--")
    right.set_yticks(places, [""] * len(names))
    right.set_xlim(left=0.0)
    label(left, "probability", "")
    label(right, "NRMSE with the effect [%]", "", "dashed: plant refitted, no effect")
    legend(right)
    return figure


def correlation_bars(correlations: Sequence[ResidualCorrelation], axis: str) -> Figure:
    """The share that each coordinate explains."""
    figure, (axes,) = panels(1, height=0.32 * len(correlations) + 0.9)
    places = np.arange(len(correlations))[::-1]
    axes.barh(places, [100.0 * one.share for one in correlations], color=FIRST, height=0.6)
    axes.set_yticks(
        places,
        [plain(one.coordinate) + (f" ({one.peak:.3g} {one.unit})" if one.peak is not None else "") for one in correlations],
    )
    axes.set_xlim(0.0, 100.0)
    label(axes, axis, "")
    return figure


def force_bars(force: InputEstimation) -> Figure:
    """The share of the residual that an unknown force explains at each location."""
    figure, (axes,) = panels(1, height=0.32 * len(force.estimates) + 0.9)
    places = np.arange(len(force.estimates))[::-1]
    axes.barh(places, [100.0 * one.share for one in force.estimates], color=FIRST, height=0.6)
    axes.set_yticks(places, [one.location.name for one in force.estimates])
    axes.set_xlim(0.0, 100.0)
    label(axes, "explained share of the residual beyond noise [%]", "")
    return figure


def force_histories(campaign: Campaign, force: InputEstimation) -> Figure:
    """Time history of the best force in each run, with the car position."""
    best = force.estimates[0]
    runs = [run for run in campaign.runs if run.file in best.histories]
    figure, axes = panels(1, len(runs), 2.0)
    for k, (axis, run) in enumerate(zip(axes, runs, strict=True)):
        course = best.histories[run.file]
        axis.plot(course.time, course.value, color=FIRST, linewidth=1.2)
        name = f"{KIND_OF_INPUT[best.location.unit]} [{best.location.unit}]"
        label(axis, "time [s]" if k == len(runs) - 1 else "", name, run.file)
        car = axis.twinx()
        car.plot(course.time, run.trip.position(course.time), color=GREY, linewidth=1.0, linestyle="--")
        label(car, "", "car [m]")
    return figure


def error_bars(names: Sequence[str], fit: Sequence[float], validate: Sequence[float]) -> Figure:
    """NRMSE at each stage, on fit and validation runs."""
    figure, (axes,) = panels(1, height=3.2)
    at = np.arange(len(names))
    for shift, values, colour, text in ((-0.2, fit, FIRST, "fit runs"), (0.2, validate, SECOND, "validation runs")):
        bars = axes.bar(at + shift, 100.0 * np.array(values), 0.38, color=colour, label=text)
        axes.bar_label(bars, fmt="%.3g", fontsize=8)
    axes.set_xticks(at, list(map(plain, names)))
    label(axes, "", "NRMSE [%]")
    legend(axes)
    return figure
