"""A study: its cases, the function that simulates one, and the evaluation of the results."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...parallel.sweep import Case, Task
from ...report.comparison_report import ComparisonReport, comparison_table
from ...report.page import Section

AGREES, DIFFERS, PARTLY = "yes", "no", "partly"


@dataclass(frozen=True)
class StudyOptions:
    """Options of the study `design`: building, running distance [m] and displacement limit [m]."""

    installation: str = "building200"
    distance: float = 22.0
    limit: float = 0.005


@dataclass(frozen=True)
class Study:
    """Cases `cases(options)`, simulated by `task` in any order and process; `evaluate(options, values)` gives the report.

    `quote` is the statement of the paper, `title` its section or figure.
    """

    name: str
    title: str
    quote: str
    cases: Callable[[StudyOptions], list[Case]]
    task: Task
    evaluate: Callable[[StudyOptions, list[Any]], ComparisonReport]

    def section(self, report: ComparisonReport) -> Section:
        """The report as a section of a page."""
        return Section(self.name, self.title, [comparison_table(report.comparisons), *report.blocks], self.quote)
