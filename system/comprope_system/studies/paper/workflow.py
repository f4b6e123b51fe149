"""Workflow of `comprope study`: run the studies selected, draw their figures, write one page."""

import importlib
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from comprope.atomic_files import require_writable
from comprope.errors import InputError
from comprope.validation_messages import suggestion

from ...parallel.executors import workers
from ...parallel.progress import Progress, no_progress
from ...parallel.sweep import sweep, values
from ...report.comparison_report import Comparison, ComparisonReport, comparison_table
from ...report.page import Section, save_page, save_pictures
from .study import Study, StudyOptions

NAMES = ("fig4", "fig5", "fig6", "fig7", "period", "fig8", "design")  # as the paper has them
PAGE, STORE = "studies.html", "results.jsonl"
TITLE = "Compensation rope: results stated in the paper and obtained"
LEAD = (
    "Every result of Nakazawa, Watanabe, Fukui and Okawa, “Lateral vibration analysis for elevator compensation rope”, "
    "reproduced. Stated values are taken from the text of the paper; for rope, sheave radius and pit, which are not stated, "
    "typical values are used."
)


@dataclass(frozen=True)
class Request:
    """Names of studies (default all), folder for the results, number of processes, address of a cluster, options."""

    names: Sequence[str]
    out: Path
    jobs: int | None = None
    executor: str | None = None
    options: StudyOptions = StudyOptions()  # noqa: RUF009 -- frozen


def run(request: Request, progress: Progress = no_progress) -> dict[str, ComparisonReport]:
    """Run the studies and write figures and page; an interrupted run in the same folder is resumed."""
    studies = [find(name) for name in request.names or NAMES]
    require_writable(request.out / PAGE)
    reports = {}
    with workers(request.jobs, request.executor) as executor:
        for study in studies:
            outcomes = sweep(study.task, study.cases(request.options), executor, request.out / STORE, study.name, progress)
            reports[study.name] = study.evaluate(request.options, values(outcomes))
    sections = [study.section(reports[study.name]) for study in studies]
    comparisons = [fact for comparison_report in reports.values() for fact in comparison_report.comparisons]
    save_pictures(request.out, sections)
    save_page(request.out / PAGE, TITLE, LEAD, [Section("summary", "Summary", [comparison_table(comparisons)]), *sections])
    _print(comparisons, request.out / PAGE)
    return reports


def find(name: str) -> Study:
    """The study of a name; raises `InputError` for another name."""
    if name not in NAMES:
        raise InputError(f"{name}: not a study; {suggestion(name, list(NAMES))}")
    study: Study = importlib.import_module(f"{__package__}.{name}").STUDY
    return study


def _print(comparisons: Sequence[Comparison], page: Path) -> None:
    sys.stdout.write(
        "".join(f"{one.verdict:<6}  {one.what}: stated {one.stated}; obtained {one.obtained}\n" for one in comparisons)
    )
    sys.stdout.write(f"written {page}\n")
