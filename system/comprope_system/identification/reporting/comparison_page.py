"""The page of `comprope compare`, and the sections that other pages share with it."""

from collections.abc import Sequence
from pathlib import Path

from ...report.page import Block, Picture, Section, save_page
from ..comparison.compare import Comparison
from . import figures, formatting, sentences, tables

DEFINITIONS = (
    "NRMSE: root-mean-square error divided by the standard deviation of the measured channel in its run; 100 % is no better than "
    "a constant. The errors by phase of the trip are normalised likewise. Reduced chi-square (red. χ²): mean square of the "
    "residual divided by the variance of the noise; near 1 the residual is explained by noise."
)


def save_comparison(path: Path, comparison: Comparison, remarks: Sequence[str]) -> None:
    """Write the page of a comparison, completely or not at all."""
    sections = [
        Section("summary", "Errors by run and channel", [DEFINITIONS, tables.error_table(comparison)]),
        data_quality_section(remarks),
        *_run_sections(comparison),
        _position_section(comparison),
        order_section(comparison, "Residual by order of the sheave's rotation"),
    ]
    title = f"{comparison.campaign.name}: model and measurement"
    save_page(path, title, " ".join(sentences.comparison_sentences(comparison)), sections)


def data_quality_section(remarks: Sequence[str]) -> Section:
    """Anomalies of the data."""
    return Section("data", "Data quality", list(remarks) or ["No anomalies were found."])


def _run_sections(comparison: Comparison) -> list[Section]:
    """One section for each run: measured and simulated channels, and residuals."""
    found = []
    for k, run in enumerate(comparison.runs, 1):
        caption = "Left: measured and simulated; right: residual. Shaded: acceleration and deceleration of the car."
        picture = Picture(f"run{k}", figures.overlay(comparison.campaign, run), caption)
        found.append(Section(f"run{k}", f"{run.file} ({run.role}): NRMSE {formatting.percent(run.nrmse)}", [picture]))
    return found


def _position_section(comparison: Comparison) -> Section:
    blocks: list[Block] = [Picture("where", figures.by_position_and_frequency(comparison)), tables.shape_table(comparison)]
    return Section("where", "Residual by car position and frequency", blocks)


def order_section(comparison: Comparison, title: str) -> Section:
    """Order spectrum of the residual."""
    caption = (
        "Amplitude of the residual over the order: periods per revolution of the sheave. A line at order 1 in every run is "
        "caused by the sheave's rotation."
    )
    return Section("orders", title, [Picture("orders", figures.orders(comparison), caption)])


def before_and_after(before: Comparison, after: Comparison) -> Section:
    """Each run before and after, validation runs first."""
    blocks: list[Block] = []
    order = sorted(range(len(before.runs)), key=lambda k: before.runs[k].role != "validate")
    for k in order:
        a, b = before.runs[k], after.runs[k]
        caption = f"{a.file} ({a.role}): NRMSE {formatting.percent(a.nrmse)} before, {formatting.percent(b.nrmse)} after."
        blocks.append(Picture(f"before_after{k + 1}", figures.overlay(before.campaign, a, {"before": a, "after": b}), caption))
    return Section("picture", "Before and after", blocks)
