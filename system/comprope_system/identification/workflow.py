"""What the commands compare, diagnose, add and journey do: read, compute, print, write."""

import sys
from collections.abc import Callable, Iterator, Sequence
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
from .reporting import formatting, sentences, tables

Say = Callable[[str], None]


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
    with progress() as say, threads() as executor:
        say("driving the model as the car was driven")
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
    from .diagnosis.experiment_design import next_runs, unsettled
    from .diagnosis.held_out_validation import judge, to_json
    from .hypotheses.model_effects import effect_values, require_effects
    from .prediction.parameter_point import Point
    from .residuals.input_estimation import residual_force
    from .residuals.residual_correlation import clues, standing_of

    campaign = _begin(request)
    require_effects(request.without)
    base = Point(effects=effect_values(campaign.model))
    with progress() as say, processes(request.jobs) as executor:
        found = diagnosis_of(campaign, executor, say, base, request.without)
        say("the runs held out")
        judged = judge(found, executor, base)
        say("the next run to measure")
        proposals = next_runs(found, executor) if unsettled(found) else []
        force = residual_force(found.problem, found.none, say) if found.kind == "unknown_effect" else None
    left = [] if found.kind == "adequate" else clues(campaign, judged.refitted.predictions)
    standing = standing_of(campaign, judged.refitted.predictions)
    _tell(*_diagnosed(judged, left, standing, force, proposals))
    if request.json:
        locked = [{"coordinate": one.coordinate, "share": one.share, "peak": one.peak} for one in left]
        told = {"clues": locked, "next_runs": [one.to_json() for one in proposals[:5]]}
        save_json(request.json, to_json(judged) | told | ({"residual_force": force.to_json()} if force else {}))
    if request.report:
        from .reporting.html_pages import save_diagnosis

        save_diagnosis(request.report, judged, left, standing, force, proposals)
    _end(request)
    return judged


def _diagnosed(judged: Any, left: Sequence[Any], standing: float, force: Any, proposals: Sequence[Any]) -> Iterator[list[str]]:
    """What is printed of a diagnosis, paragraph by paragraph."""
    from .diagnosis.held_out_validation import full_name
    from .residuals.residual_correlation import hints

    found = judged.diagnosis
    yield formatting.wrapped(*sentences.verdict(judged))
    yield formatting.plain_table(tables.ranking_table(judged, tables.SHOWN))
    yield _listed("About the data:", judged.remarks)
    if found.kind == "unknown_effect":
        yield _listed("What is left:", hints(list(left), standing))
    if force:
        yield [*formatting.wrapped(f"{force.told()}."), *formatting.plain_table(tables.force_table(force, tables.SHOWN))]
    if proposals:
        yield [f"Next run to measure: {proposals[0].told()}."]
    if found.verdict:
        command = "comprope --allow-code add" if found.campaign.model.own_effects else "comprope add"
        yield [f"To add it: {command} {found.campaign.folder} {full_name(found.ranking[0].hypothesis)} --out MODEL.toml"]


def add(request: Request, effect: str) -> Any:
    """`comprope add`."""
    from .hypotheses.model_effects import alternatives
    from .model_updating.add_effect import add as add_to
    from .model_updating.add_effect import heading

    campaign = _begin(request)
    alternatives(effect, campaign, ())
    with progress() as say, processes(request.jobs) as executor:
        found = add_to(campaign, effect, executor, say)
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
    with progress() as say, processes(request.jobs) as executor:
        found = travel(campaign, executor, say)
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
def progress() -> Iterator[Say]:
    """On a terminal, what is being done and for how long."""
    console = Console(file=sys.stderr)
    parts = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*parts, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("starting", total=None)
        yield lambda text: bar.update(task, description=text)
