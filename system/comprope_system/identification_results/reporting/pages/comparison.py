"""The page of `comprope compare`, and the sections that other pages share with it."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from ....identification.comparison.compare import Comparison
from ....identification.comparison.largest_error import largest_error
from ....identification.preview.effect_preview import EffectPreview
from ....report.page import Block, Section, save_page
from .. import heat_maps, tables
from ..run_curves import order_curves, run_curves
from ..texts import sentences
from .preview import preview_section

DEFINITIONS = (
    "NRMSE: root-mean-square error divided by the standard deviation of the measured channel in its run; 100 % is no better than "
    "a constant. The errors by phase of the trip are normalised likewise. Reduced chi-square (red. χ²): mean square of the "
    "residual divided by the variance of the noise; near 1 the residual is explained by noise."
)
CURVES = "curves"  # name of the figure with the runs


def save_comparison(
    path: Path,
    comparison: Comparison,
    remarks: Sequence[str],
    previews: Sequence[EffectPreview] = (),
    variants: Mapping[str, Comparison] | None = None,
) -> None:
    """Write the page of a comparison, with further models by their names, completely or not at all."""
    models = {"model": comparison, **(variants or {})}
    sections = [
        *([Section("models", "Models", [tables.stage_table(models)])] if variants else []),
        Section("summary", "Errors by run, channel and phase", [heat_maps.error_map(comparison, CURVES), DEFINITIONS]),
        data_quality_section(remarks),
        Section("runs", "Measured and simulated", [run_curves(CURVES, models, worst_run(comparison))]),
        *preview_section(previews, comparison, worst_run(comparison), fitted=False),
        _position_section(comparison),
        order_section(comparison, "Residual by order of the sheave's rotation", "the model as given"),
    ]
    title = f"{comparison.campaign.name}: model and measurement"
    lead = " ".join([sentences.largest_error_sentence(comparison), *sentences.comparison_sentences(comparison)])
    save_page(path, title, lead, sections)


def worst_run(comparison: Comparison) -> str:
    """The run whose curves are shown first: that of the largest error, else the first."""
    worst = largest_error(comparison)
    return worst.file if worst else comparison.runs[0].file


def data_quality_section(remarks: Sequence[str]) -> Section:
    """Anomalies of the data, folded if there are none."""
    return Section("data", "Data quality", list(remarks) or ["No anomalies were found."], folded=not remarks)


def _position_section(comparison: Comparison) -> Section:
    maps = [heat_maps.position_map(comparison), heat_maps.frequency_map(comparison)]
    blocks: list[Block] = [*maps, tables.shape_table(comparison)]
    return Section("where", "Residual by car position and frequency", blocks)


def order_section(comparison: Comparison, title: str, fit: str, folded: bool = False) -> Section:
    """Order spectrum of the residual of a fit that `fit` names."""
    text = (
        f"Residual of {fit}. Amplitude over the order: periods per revolution of the sheave. A line at order 1 in every run is "
        "caused by the sheave's rotation."
    )
    curves = order_curves(comparison)
    known = bool(curves.groups[0].panels)
    return Section("orders", title, [text, curves if known else "In no run does the sheave turn often enough."], folded=folded)


def before_and_after(before: Comparison, after: Comparison, fit: str) -> Section:
    """Each run before and after, as of a fit that `fit` names; of the runs, the worst is shown first."""
    caption = f"Before: the model as given. After: {fit}. Numbers beside a channel are those after."
    curves = run_curves(CURVES, {"before": before, "after": after}, worst_run(before), caption)
    return Section("picture", "Before and after", [curves, heat_maps.error_map(after, CURVES, f"After: {fit}. ")])
