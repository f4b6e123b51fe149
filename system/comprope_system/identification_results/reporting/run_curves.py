"""Curves of a page: measured and simulated channels of each run with the phases of the trip, and order spectra."""

import itertools
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...identification.comparison.compare import ChannelComparison, Comparison, RunComparison
from ...identification.comparison.error_metrics import ORDERS
from ...identification.data.runs import Run
from ...identification.data.trip_phases import phases
from ...report.curves import BEFORE, EQUAL_STYLES, MEASURED, MODEL, Curve, Curves, Group, Panel, Span
from .texts import formatting

Floats = NDArray[np.float64]
BAND = 2.0  # standard deviations: half width of the band of the noise
VARIANTS = ("2", "3", "6", "7", "4")  # styles of the models between the first and the last, which are told apart
MOST_MODELS = 2 + len(VARIANTS)
TINTED = ("acceleration", "deceleration")


def run_curves(name: str, stages: Mapping[str, Comparison], first: str, caption: str = "") -> Curves:
    """Measured channels of each run and models of them by name, the last being the result; the run `first` is shown at once."""
    files = [run.file for run in next(iter(stages.values())).runs]
    groups = [_group(stages, k, file == first) for k, file in enumerate(files)]
    return Curves(name, groups, caption=caption)


def _group(stages: Mapping[str, Comparison], k: int, shown: bool) -> Group:
    """One run, its channels those that have values."""
    comparison = next(iter(stages.values()))
    run = next(one for one in comparison.campaign.runs if one.file == comparison.runs[k].file)
    models = {stage: one.runs[k] for stage, one in stages.items()}
    several = len(models) > 1
    errors = ", ".join(formatting.percent(one.nrmse) + (f" {stage}" if several else "") for stage, one in models.items())
    panels = [_panel(comparison, run, models, j) for j in channels_shown(comparison.runs[k])]
    return Group(run.file, f"{run.file} ({run.role}): NRMSE {errors}", panels, phase_spans(run), shown)


def channels_shown(run: RunComparison) -> list[int]:
    """Numbers of the channels of a run that have values."""
    return [j for j, one in enumerate(run.channels) if len(one.time)]


def _panel(comparison: Comparison, run: Run, models: Mapping[str, RunComparison], j: int) -> Panel:
    """One channel, measured and simulated by each of the models, in its own unit."""
    found = {stage: one.channels[j] for stage, one in models.items()}
    one, *_ = found.values()
    place = np.unique(np.concatenate([each.time for each in found.values()]))
    measured = np.full(len(place), np.nan)
    for each in found.values():
        measured[np.searchsorted(place, each.time)] = each.measured / each.channel.scale
    curves = [Curve("measured", MEASURED, measured)]
    styles = (*((BEFORE,) if len(found) > 1 else ()), *VARIANTS[: max(len(found) - 2, 0)], MODEL)
    for (stage, each), style in zip(found.items(), styles, strict=True):
        curves.append(Curve(stage, style, _placed(place, each)))
    last = list(found.values())[-1]
    error = f"RMS error {formatting.number(last.rmse / last.channel.scale)} {last.channel.unit}"
    detail = f"NRMSE {formatting.percent(last.nrmse)}, {error}, reduced chi-square {formatting.number(last.reduced_chi_square)}"
    return Panel(one.column, one.channel.unit, place, curves, detail, noise_spans(comparison, run, one))


def _placed(place: Floats, one: ChannelComparison) -> Floats:
    """A prediction at all times of a panel, NaN where it has none."""
    values = np.full(len(place), np.nan)
    values[np.searchsorted(place, one.time)] = one.predicted / one.channel.scale
    return values


def noise_spans(comparison: Comparison, run: Run, one: ChannelComparison) -> list[tuple[float, float, float]]:
    """Spans (from, to, half width) of the band of a channel's noise, which may be wider while the car moves."""
    noise = comparison.campaign.noise[one.column]
    width = BAND * noise.scale(run) / one.channel.scale
    edges = [0, *(np.flatnonzero(np.diff(width)) + 1), len(width) - 1]
    return [(float(run.time[a]), float(run.time[b]), float(width[a])) for a, b in itertools.pairwise(edges) if b > a]


def phase_spans(run: Run) -> list[Span]:
    """Phases of the trip, each up to the beginning of the next."""
    starts = [(name, float(run.time[np.argmax(mask)])) for name, mask in phases(run.trip, run.time).items() if mask.any()]
    ends = [start for _, start in starts[1:]] + [float(run.time[-1])]
    return [
        Span(name.replace("_", " "), start, end, name in TINTED) for (name, start), end in zip(starts, ends, strict=True)
    ]


def order_curves(comparison: Comparison) -> Curves:
    """Order spectrum of the residual: a panel for each channel, a curve for each run."""
    panels = []
    for column, channel in comparison.campaign.channels.items():
        found = [(run.file, next(c for c in run.channels if c.column == column)) for run in comparison.runs]
        curves = [Curve(file, str(k % EQUAL_STYLES), one.orders / channel.scale) for k, (file, one) in enumerate(found)]
        if any(np.isfinite(one.value).any() for one in curves):
            panels.append(Panel(column, channel.unit, ORDERS, curves))
    title = "Amplitude of the residual over periods per revolution of the sheave"
    return Curves("order_curves", [Group("orders", title, panels)], unit="", kind="spectra")
