"""Pages of comparison, diagnosis, added effects and journeys, put together from words, tables and pictures."""

from collections.abc import Sequence
from pathlib import Path

from ...report.page import Block, Picture, Section, Table, save_page
from ..comparison.compare import Comparison
from ..diagnosis.experiment_design import ProposedRun, best_two_fits
from ..diagnosis.held_out_validation import ValidatedDiagnosis, ranking
from ..model_updating.add_effect import Added
from ..model_updating.backward_elimination import Without
from ..model_updating.stepwise_selection import Journey
from ..residuals.input_estimation import InputEstimation
from ..residuals.residual_correlation import ResidualCorrelation, correlation_sentences
from . import figures, formatting, sentences, tables

HOW = (
    "Errors are root mean squares over the standard deviation of the measured channel in its run. χ² per sample is the "
    "mean square of what is left over that of the noise: near 1 there is nothing left to explain."
)


def remark_section(remarks: Sequence[str]) -> Section:
    """What a person should know about the data."""
    return Section("data", "About the data", list(remarks) or ["Nothing about the data is odd."])


# -- comparison --------------------------------------------------------------------------------------


def save_comparison(path: Path, comparison: Comparison, remarks: Sequence[str]) -> None:
    """The page of `comprope compare`."""
    sections = [
        Section("summary", "How far off", [HOW, tables.error_table(comparison)]),
        remark_section(remarks),
        *run_sections(comparison),
        *where_sections(comparison),
    ]
    save_page(path, f"{comparison.campaign.name}: model against measurement", sentences.compared(comparison), sections)


def run_sections(comparison: Comparison) -> list[Section]:
    """One section for each run: overlay and residual."""
    found = []
    for k, run in enumerate(comparison.runs, 1):
        caption = "Measured and modelled, and what is left. Shaded: the car speeds up or slows down."
        picture = Picture(f"run{k}", figures.overlay(comparison.campaign, run), caption)
        found.append(Section(f"run{k}", f"{run.file} ({run.role}): {formatting.percent(run.nrmse)}", [picture]))
    return found


def where_sections(comparison: Comparison) -> list[Section]:
    """Where in the shaft, at which frequency and at which order of turning the error lies."""
    return [
        Section("where", "Where and how fast", [Picture("where", figures.where(comparison)), tables.shape_table(comparison)]),
        Section("orders", "What turns with the sheave", [order_picture(comparison)]),
    ]


def order_picture(comparison: Comparison) -> Picture:
    """Order spectrum of what is left."""
    caption = "Amplitude of what is left against the sheave's angle. A line at 1 in every run turns with the sheave."
    return Picture("orders", figures.orders(comparison), caption)


# -- diagnosis ---------------------------------------------------------------------------------------


def save_diagnosis(
    path: Path,
    validated: ValidatedDiagnosis,
    correlations: Sequence[ResidualCorrelation],
    rest_ratio: float,
    force: InputEstimation | None,
    proposals: Sequence[ProposedRun],
) -> None:
    """The page of `comprope diagnose`."""
    found = validated.diagnosis
    lead = sentences.verdict(validated)
    sections = [
        Section("verdict", "What is missing", [*lead[1:], *ranking_blocks(validated)]),
        remark_section(validated.remarks),
        Section("picture", "Before and after", before_after(validated.before, validated.best)),
        Section("unseen", "What these data cannot see", unseen_blocks(validated)),
        Section("plant", "What happened to the plant's parameters", [PLANT, tables.plant_table(found)]),
        Section("orders", "What turns with the sheave", [order_picture(validated.best)]),
    ]
    if correlations:
        sections.insert(3, Section("clues", "What the model's error is locked to", correlation_blocks(correlations, rest_ratio)))
    if force:
        sections.insert(4, Section("force", "Which force would explain it", force_blocks(validated, force)))
    if proposals:
        sections.append(Section("next", "The next run to measure", next_blocks(validated, proposals)))
    save_page(path, f"{found.campaign.name}: which effect is missing", lead[0], sections)


PLANT = (
    "A model without an effect that acts bends its plant's parameters to make up for it. Parameters that moved by several "
    "of their usual deviations are a sign that something is still missing."
)


def ranking_blocks(validated: ValidatedDiagnosis) -> list[Block]:
    """The ranking as picture and table."""
    entries = ranking(validated)
    names = [tables.named(one) for one in entries]
    plant = (validated.refitted.fit_nrmse, validated.refitted.validate_nrmse)
    caption = "Errors of effects that were not refined on the full model are estimated from their linear look."
    return [Picture("ranking", figures.ranking(entries, names, plant), caption), tables.ranking_table(validated)]


def unseen_blocks(validated: ValidatedDiagnosis) -> list[Block]:
    """Least detectable sizes and pairs that cannot be told apart."""
    pairs = [f"{a} and {b}" for a, b in validated.diagnosis.indistinguishable]
    told = (
        f"Not to be told apart with these data: {'; '.join(pairs)}." if pairs else "No two effects look the same in these data."
    )
    return [told, tables.least_table(validated)]


def before_after(before: Comparison, after: Comparison) -> list[Block]:
    """Each run before and after, those held out first."""
    blocks: list[Block] = []
    order = sorted(range(len(before.runs)), key=lambda k: before.runs[k].role != "validate")
    for k in order:
        a, b = before.runs[k], after.runs[k]
        caption = f"{a.file} ({a.role}): error {formatting.percent(a.nrmse)} before, {formatting.percent(b.nrmse)} after."
        blocks.append(Picture(f"before_after{k + 1}", figures.overlay(before.campaign, a, {"before": a, "after": b}), caption))
    return blocks


def correlation_blocks(correlations: Sequence[ResidualCorrelation], rest_ratio: float) -> list[Block]:
    """Bars and sentences about what the residual follows."""
    method = (
        "Profiles come from all runs but one and are tried on that one; a sinusoid in time or in the sheave's angle may "
        "begin anywhere in each run."
    )
    return [
        *(f"{text[0].upper()}{text[1:]}." for text in correlation_sentences(list(correlations), rest_ratio)),
        Picture("clues", figures.correlation_bars(correlations), method),
    ]


def force_blocks(validated: ValidatedDiagnosis, force: InputEstimation) -> list[Block]:
    """Where an unknown force would act, its course in each run, and what that follows."""
    method = (
        "One force at a time, free over the time of each run and smooth; the plant is refitted beside it. Each is judged on "
        "channels and seconds that were left out of its estimate. Dashed in the next picture: the car's position."
    )
    blocks: list[Block] = [f"{force.sentence()}.", Picture("force", figures.force_bars(force), method), tables.force_table(force)]
    blocks.append(
        Picture("courses", figures.force_histories(validated.diagnosis.campaign, force), "The force at the first place.")
    )
    if force.correlations:
        blocks.append(
            Picture("force_clues", figures.correlation_bars(force.correlations), "How much of that force follows what.")
        )
    return blocks


def next_blocks(validated: ValidatedDiagnosis, proposals: Sequence[ProposedRun]) -> list[Block]:
    """Runs that would separate the rivals best."""
    pair = best_two_fits(validated.diagnosis)
    names = " and ".join(name for name, _ in pair) if pair else ""
    rows = [(one.sentence(), f"{one.distance:.1f}") for one in proposals[:5]]
    told = f"These runs would tell {names} apart best, both taken as fitted to the runs there are."
    return [told, Table(("run", "deviations apart, in the mean"), rows)]


# -- added effects -----------------------------------------------------------------------------------


def save_added(path: Path, added: Added) -> None:
    """The page of `comprope add`."""
    title = f"{added.before.campaign.name}: {added.effect} {'refitted' if added.was_there else 'added'}"
    save_page(path, title, sentences.added(added), added_sections(added))


VALUES = "In SI units, with one standard deviation and a 95 % interval; the effect first, then the plant fitted with it."


def added_sections(added: Added) -> list[Section]:
    """What an effect bought, its values, and pictures of before and after."""
    stages = {"as it stood": added.before, "plant refitted": added.refitted, f"with {added.effect}": added.after}
    fit, held = [one.fit_nrmse for one in stages.values()], [one.validate_nrmse for one in stages.values()]
    return [
        Section(
            "bought", "What it bought", [Picture("bought", figures.stairs(list(stages), fit, held)), tables.fall_table(stages)]
        ),
        Section("values", "Fitted values", [VALUES, tables.value_table(added.effects), tables.value_table(added.plant)]),
        Section("picture", "Before and after", before_after(added.before, added.after)),
        Section("orders", "What turns with the sheave, after", [order_picture(added.after)]),
    ]


def save_journey(path: Path, found: Journey) -> None:
    """The page of `comprope journey`."""
    names = [one.name for one in found.steps]
    stairs = figures.stairs(names, [one.fit for one in found.steps], [one.validate for one in found.steps])
    steps: list[Block] = [
        Picture("steps", stairs, "The error after each step."),
        tables.bought_table(found),
        without_table(found.without, len(found.last.problem.data)),
    ]
    sections = [Section("steps", "What each effect bought", steps), *added_sections(found.added)[1:]]
    save_page(path, f"{found.last.campaign.name}: from failing to fitting", sentences.travelled(found), sections)


def without_table(without: Sequence[Without], count: int) -> Table:
    """What would be left without each effect."""
    rows = [
        (one.effect, formatting.number(one.fitted.chi_square / max(count, 1)), "no" if one.could_go else "yes") for one in without
    ]
    return Table(("without", "left / noise", "needed"), rows, "Backward: the final model without each of its effects, refitted")
