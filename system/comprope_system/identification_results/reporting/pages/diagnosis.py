"""The page of `comprope diagnose`."""

from collections.abc import Sequence
from pathlib import Path

from ....identification.diagnosis.experiment_design import ProposedRun, best_two_fits
from ....identification.diagnosis.held_out_validation import ValidatedDiagnosis, implausible_parameters, ranking
from ....identification.preview.effect_preview import EffectPreview
from ....identification.residuals.effect_skeleton import effect_skeleton
from ....identification.residuals.input_estimation import InputEstimation
from ....identification.residuals.residual_correlation import ResidualCorrelation, correlation_sentences
from ....identification.settings import CORRELATION, EXPERIMENTS
from ....report.page import Block, Listing, Picture, Section, Table, save_page
from .. import figures, tables
from ..texts import sentences
from .comparison import before_and_after, data_quality_section, order_section, worst_run
from .preview import preview_section
from .verdict_card import verdict_card

PLANT = (
    "If an effect is missing from the model, the fit changes plant parameters to compensate for it. Deviations of several prior "
    "standard deviations indicate that an effect is still missing."
)
RUNS_SHOWN = 5  # of the proposed runs


def save_diagnosis(
    path: Path,
    validated: ValidatedDiagnosis,
    correlations: Sequence[ResidualCorrelation],
    rest_ratio: float,
    force: InputEstimation | None,
    proposals: Sequence[ProposedRun],
    previews: Sequence[EffectPreview] = (),
) -> None:
    """Write the page of a diagnosis, completely or not at all."""
    found, fit = validated.diagnosis, fit_name(validated)
    first, *rest = sentences.verdict_sentences(validated)
    alike = any(found.verdict in pair for pair in found.indistinguishable)
    certain = not alike and max(found.probabilities.values()) > EXPERIMENTS.conclusive_probability
    sections = [
        Section("verdict", "Verdict", [verdict_card(validated, proposals), *rest]),
        data_quality_section(validated.remarks),
        before_and_after(validated.before, validated.best, fit),
        *preview_section(previews, validated.before, worst_run(validated.before), fitted=True),
    ]
    if correlations:
        clear = any(one.share > CORRELATION.min_share for one in correlations)
        blocks = _correlation_blocks(correlations, rest_ratio)
        sections.append(Section("correlations", "Residual correlations", blocks, folded=not clear))
    if force:
        sections.append(Section("force", "Estimated force", _force_blocks(validated, force)))
    sections += [
        Section("ranking", "Ranking of all effects", _ranking_blocks(validated), folded=certain),
        Section("limits", "Indistinguishable effects and detection limits", _limit_blocks(validated)),
        Section("plant", "Plant parameters", _plant_blocks(validated), folded=not implausible_parameters(found)),
        order_section(validated.best, "Residual by order of the sheave's rotation", fit, folded=True),
    ]
    if proposals:
        sections.append(Section("next", "Proposed next run", _next_run_blocks(validated, proposals)))
    save_page(path, f"{found.campaign.name}: diagnosis", first, sections)


def fit_name(validated: ValidatedDiagnosis) -> str:
    """The fit that the page shows as the result."""
    if not validated.diagnosis.verdict:
        return "the model with refitted plant parameters, no effect"
    return f"the model with {tables.effect_names(ranking(validated)[0])} and refitted plant parameters"


def _plant_blocks(validated: ValidatedDiagnosis) -> list[Block]:
    """Plant parameters of the verdict's fit."""
    return [f"Fit: {fit_name(validated)}.", PLANT, tables.plant_table(validated.diagnosis)]


def _ranking_blocks(validated: ValidatedDiagnosis) -> list[Block]:
    """The ranking as picture and table."""
    entries = ranking(validated)
    names = [tables.effect_names(one) for one in entries]
    plant = (validated.refitted.fit_nrmse, validated.refitted.validate_nrmse)
    caption = (
        "Each effect with plant parameters refitted to it. Effects marked as linearised were not fitted on the full model: "
        "their errors are those of the linear screening."
    )
    return [Picture("ranking", figures.ranking(entries, names, plant), caption), tables.ranking_table(validated)]


def _limit_blocks(validated: ValidatedDiagnosis) -> list[Block]:
    """Pairs of indistinguishable effects, and detection limits."""
    pairs = [f"{a} and {b}" for a, b in validated.diagnosis.indistinguishable]
    alike = f"Indistinguishable with these data: {'; '.join(pairs)}."
    text = alike if pairs else "All effects are distinguishable with these data."
    limits = "Detection limits are those of a linear screening about the fit of the plant parameters alone."
    return [text, limits, tables.detection_limit_table(validated)]


def _correlation_blocks(correlations: Sequence[ResidualCorrelation], rest_ratio: float) -> list[Block]:
    """Sentences and bars: what the residual correlates with."""
    method = (
        "Residual of the model with refitted plant parameters, no effect. Cross-validated: profiles are estimated from all runs "
        "but one and evaluated on that one; a sinusoid in time or in the sheave's angle has a free phase in each run."
    )
    return [
        *(f"{text[0].upper()}{text[1:]}." for text in correlation_sentences(list(correlations), rest_ratio)),
        Picture("correlations", figures.correlation_bars(correlations, "explained share of the residual [%]"), method),
    ]


def _force_blocks(validated: ValidatedDiagnosis, force: InputEstimation) -> list[Block]:
    """Locations of the estimated force, its time history in each run, and what it correlates with."""
    method = (
        "One force at a time, a smooth function of time in each run; plant parameters are refitted with it. The shares are "
        "cross-validated on channels and seconds that were not used for the estimate."
    )
    history = "Time history of the force at the best location. Dashed: car position."
    blocks: list[Block] = [
        f"{force.sentence()}.",
        Picture("force", figures.force_bars(force), method),
        tables.force_table(force),
        Picture("force_histories", figures.force_histories(validated.diagnosis.campaign, force), history),
    ]
    if force.correlations:
        bars = figures.correlation_bars(force.correlations, "explained share of the force [%]")
        blocks.append(Picture("force_correlations", bars, "What the estimated force correlates with."))
    if skeleton := effect_skeleton(force, validated.diagnosis.campaign):
        caption = "The file of an effect of your own to begin with; `comprope diagnose --skeleton FILE.py` writes it."
        blocks.append(Listing(skeleton, caption))
    return blocks


def _next_run_blocks(validated: ValidatedDiagnosis, proposals: Sequence[ProposedRun]) -> list[Block]:
    """Runs that discriminate best between the two best fits."""
    pair = best_two_fits(validated.diagnosis)
    names = " and ".join(name for name, _ in pair) if pair else ""
    rows = [(one.sentence(), f"{one.distance:.1f}") for one in proposals[:RUNS_SHOWN]]
    text = f"Runs that discriminate best between {names}, each with the parameters fitted to the present runs."
    return [text, Table(("run", "RMS difference in standard deviations"), rows)]
