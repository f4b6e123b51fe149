"""Pictures of comparison, diagnosis and added effects."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...identification.data.campaign import Campaign
from ...identification.residuals.input_estimation import InputEstimation
from ...identification.residuals.residual_correlation import ResidualCorrelation
from ...report.plot_style import FIRST, GREY, SECOND, label, legend, panels, plain

Floats = NDArray[np.float64]
MEASURED, PHASE = SECOND, "#eef2f6"
KIND_OF_INPUT = {"N": "force", "N.m": "torque", "N/m": "line load", "m": "displacement"}  # by its unit


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
