"""Errors by run, channel and phase of the trip, by car position and by frequency, as coloured tables."""

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...identification.comparison.compare import ChannelComparison, Comparison, RunComparison
from ...identification.data.trip_phases import PHASES
from ...identification.settings import COMPARISON
from ...report.heat_map import HeatCell, HeatMap, Target, level_of, level_sentence
from .run_curves import channels_shown
from .texts.formatting import number, percent

Floats = NDArray[np.float64]


def error_map(comparison: Comparison, curves: str, caption: str = "") -> HeatMap:
    """Errors by run and channel, and NRMSE by phase of the trip; each leads to its panel in the figure `curves`."""
    names = [name.replace("_", " ") for name in PHASES]
    head = ("channel", "NRMSE", "RMS error", "red. χ²", *names)
    rows: list[list[str | HeatCell]] = []
    for k, run in enumerate(comparison.runs):
        rows.append([f"{run.file} ({run.role}): NRMSE {percent(run.nrmse)}"])
        rows += (_error_row(k, run, j, curves) for j in range(len(run.channels)))
    return HeatMap(
        head,
        rows,
        caption=f"{caption}NRMSE by phase of the trip; a click shows the curves. {level_sentence()} "
        "What noise explains is not coloured.",
    )


def _error_row(k: int, run: RunComparison, j: int, curves: str) -> list[str | HeatCell]:
    one, shown = run.channels[j], channels_shown(run)
    target = Target(curves, k, shown.index(j)) if j in shown else None
    scale, unit = one.channel.scale, one.channel.unit
    variation = one.rmse / one.nrmse if one.nrmse else float("nan")
    noise = one.noise / variation * COMPARISON.adequate**0.5  # the largest error that noise explains
    whole = HeatCell(percent(one.nrmse), _level_beyond(noise, one.nrmse), target=target)
    row: list[str | HeatCell] = [
        one.column, whole, f"{number(one.rmse / scale)} {unit}", number(one.reduced_chi_square),
    ]  # fmt: skip
    for name in PHASES:
        share, span = one.by_phase.get(name, float("nan")), name.replace("_", " ")
        title = f"{run.file}, {one.column}, {span}: RMS error {number(share * variation / scale)} {unit}"
        known = bool(np.isfinite(share))
        there = Target(curves, k, target.panel, span) if target and known else None
        row.append(HeatCell(percent(share), _level_beyond(noise, share), title if known else "", there))
    return row


def _level_beyond(noise: float, share: float) -> int:
    """The level of a share, none where noise of this share explains it."""
    return level_of(share) if share > noise else 0


def position_map(comparison: Comparison) -> HeatMap:
    """NRMSE of each channel by car position, root mean square over the runs."""
    edges = np.linspace(0.0, comparison.campaign.model.shaft.height, COMPARISON.position_bins + 1)
    head = ("car position [m]", *(f"{a:.3g}–{b:.3g}" for a, b in itertools.pairwise(edges)))
    rows = [_row(column, [one.by_place for one in found]) for column, found in _by_channel(comparison)]
    return HeatMap(head, rows, caption="NRMSE by car position, root mean square over the runs")


def frequency_map(comparison: Comparison) -> HeatMap:
    """NRMSE of each channel by frequency band, root mean square over the runs."""
    bands = [f"{a:g}–{b:g}" if np.isfinite(b) else f"over {a:g}" for a, b in itertools.pairwise(COMPARISON.frequency_bands)]
    rows = [_row(column, [one.by_band for one in found]) for column, found in _by_channel(comparison)]
    return HeatMap(("frequency [Hz]", *bands), rows, caption="NRMSE by frequency band, root mean square over the runs")


def _by_channel(comparison: Comparison) -> list[tuple[str, list[ChannelComparison]]]:
    """The comparisons of each channel in all runs."""
    return [
        (column, [one for run in comparison.runs for one in run.channels if one.column == column])
        for column in comparison.campaign.channels
    ]


def _row(column: str, rows: Sequence[Floats]) -> list[str | HeatCell]:
    return [column, *(HeatCell(percent(share), level_of(share)) for share in root_mean_square(rows))]


def root_mean_square(rows: Sequence[Floats]) -> Floats:
    """Root mean square over rows, NaN left out."""
    squares = np.square(np.array(rows, float))
    known = np.isfinite(squares)
    return np.asarray(np.sqrt(np.where(known, squares, 0.0).sum(0) / np.where(known.any(0), known.sum(0), np.nan)))
