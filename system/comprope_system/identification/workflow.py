"""What the commands compare, diagnose, add and journey do: read, compute, print, write."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from comprope.atomic_files import require_writable
from comprope.rope.model_file import dump

from ..parallel.executors import processes, threads
from ..report.json_output import save_json
from .data.campaign import Campaign, load_campaign
from .progress import ProgressCallback
from .reporting import formatting, sentences, tables


@dataclass(frozen=True)
class Request:
    """The campaign's folder, files to write, processes (all cores if None), and effects that a diagnosis rules out."""

    campaign: Path
    json: Path | None = None
    report: Path | None = None
    model: Path | None = None
    jobs: int | None = None
    without: tuple[str, ...] = ()


def compare(request: Request) -> Any:
    """`comprope compare`."""
    from .comparison.compare import compare as comparison_of
    from .comparison.data_quality import remarks

    campaign = _begin(request)
    with progress_display() as report_progress, threads() as executor:
        report_progress("driving the model as the car was driven")
        found = comparison_of(campaign, executor)
    told = remarks(campaign, found.predictions)
    errors = formatting.plain_table(tables.error_table(found))
    _tell(formatting.wrapped(sentences.compared(found)), errors, _listed("About the data:", told))
    if request.json:
        save_json(request.json, found.to_json() | {"remarks": told})
    if request.report:
        from .reporting.html_pages import save_comparison

        save_comparison(request.report, found, told)
    _end(request)
    return found


def diagnose(request: Request) -> Any:
    """`comprope diagnose`."""
    from .diagnosis.diagnose import diagnose as diagnosis_of
    from .diagnosis.experiment_design import is_inconclusive, rank_candidate_runs
    from .diagnosis.held_out_validation import to_json, validate
    from .hypotheses.model_effects import effect_values, require_effects
    from .prediction.parameter_point import ParameterPoint
    from .residuals.input_estimation import estimate_residual_force
    from .residuals.residual_correlation import residual_correlations, rest_ratio_of

    campaign = _begin(request)
    require_effects(request.without)
    base = ParameterPoint(effects=effect_values(campaign.model))
    with progress_display() as report_progress, processes(request.jobs) as executor:
        found = diagnosis_of(campaign, executor, report_progress, base, request.without)
        report_progress("the runs held out")
        validated = validate(found, executor, base)
        report_progress("the next run to measure")
        proposals = rank_candidate_runs(found, executor) if is_inconclusive(found) else []
        force = (
            estimate_residual_force(found.problem, found.baseline, report_progress) if found.kind == "unknown_effect" else None
        )
    left = [] if found.kind == "adequate" else residual_correlations(campaign, validated.refitted.predictions)
    rest_ratio = rest_ratio_of(campaign, validated.refitted.predictions)
    _tell(*_diagnosed(validated, left, rest_ratio, force, proposals))
    if request.json:
        correlations_of = [{"coordinate": one.coordinate, "share": one.share, "peak": one.peak} for one in left]
        told = {"clues": correlations_of, "next_runs": [one.to_json() for one in proposals[:5]]}
        save_json(request.json, to_json(validated) | told | ({"residual_force": force.to_json()} if force else {}))
    if request.report:
        from .reporting.html_pages import save_diagnosis

        save_diagnosis(request.report, validated, left, rest_ratio, force, proposals)
    _end(request)
    return validated


def _diagnosed(
    validated: Any, left: Sequence[Any], rest_ratio: float, force: Any, proposals: Sequence[Any]
) -> Iterator[list[str]]:
    """What is printed of a diagnosis, paragraph by paragraph."""
    from .diagnosis.held_out_validation import full_name
    from .residuals.residual_correlation import correlation_sentences

    found = validated.diagnosis
    yield formatting.wrapped(*sentences.verdict(validated))
    yield formatting.plain_table(tables.ranking_table(validated, tables.SHOWN))
    yield _listed("About the data:", validated.remarks)
    if found.kind == "unknown_effect":
        yield _listed("What is left:", correlation_sentences(list(left), rest_ratio))
    if force:
        yield [*formatting.wrapped(f"{force.sentence()}."), *formatting.plain_table(tables.force_table(force, tables.SHOWN))]
    if proposals:
        yield [f"Next run to measure: {proposals[0].sentence()}."]
    if found.verdict:
        command = "comprope --allow-code add" if found.campaign.model.own_effects else "comprope add"
        yield [f"To add it: {command} {found.campaign.folder} {full_name(found.ranking[0].hypothesis)} --out MODEL.toml"]


def add(request: Request, effect: str) -> Any:
    """`comprope add`."""
    from .hypotheses.model_effects import hypotheses_named
    from .model_updating.add_effect import add as add_to
    from .model_updating.add_effect import heading

    campaign = _begin(request)
    hypotheses_named(effect, campaign, ())
    with progress_display() as report_progress, processes(request.jobs) as executor:
        found = add_to(campaign, effect, executor, report_progress)
    stages = {"as it stood": found.before, "plant refitted": found.refitted, "with it": found.after}
    _tell(
        formatting.wrapped(sentences.added(found)),
        formatting.plain_table(tables.fall_table(stages)),
        formatting.plain_table(tables.value_table(found.effects)),
    )
    if request.model:
        dump(found.model, request.model, heading(found))
    if request.json:
        save_json(request.json, found.to_json())
    if request.report:
        from .reporting.html_pages import save_added

        save_added(request.report, found)
    _end(request)
    return found


def journey(request: Request) -> Any:
    """`comprope journey`."""
    from .model_updating.add_effect import heading
    from .model_updating.stepwise_selection import journey as travel

    campaign = _begin(request)
    with progress_display() as report_progress, processes(request.jobs) as executor:
        found = travel(campaign, executor, report_progress)
    told = (tables.bought_table(found), tables.value_table(found.added.effects))
    _tell(formatting.wrapped(sentences.travelled(found)), *map(formatting.plain_table, told))
    if request.model:
        dump(found.model, request.model, heading(found.added))
    if request.json:
        save_json(request.json, found.to_json())
    if request.report:
        from .reporting.html_pages import save_journey

        save_journey(request.report, found)
    _end(request)
    return found


def _begin(request: Request) -> Campaign:
    """Refuse files that could not be written, then read the campaign."""
    for path, kind in ((request.json, None), (request.model, None), (request.report, "page")):
        if path:
            require_writable(path, kind)
    return load_campaign(request.campaign)


def _end(request: Request) -> None:
    _tell([f"written {path}" for path in (request.model, request.json, request.report) if path])


def _listed(title: str, items: Sequence[str]) -> list[str]:
    return [title, *(f"  {item}" for item in items)] if items else []


def _tell(*paragraphs: list[str]) -> None:
    told = ["\n".join(lines) for lines in paragraphs if lines]
    sys.stdout.write("".join(f"{text}\n\n" for text in told))


@contextmanager
def progress_display() -> Iterator[ProgressCallback]:
    """On a terminal, what is being done and for how long."""
    console = Console(file=sys.stderr)
    parts = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*parts, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("starting", total=None)
        yield lambda text: bar.update(task, description=text)
