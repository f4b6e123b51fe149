"""A check of the numerics: a title, and the simulations that decide it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ...report.comparison_report import Comparison, ComparisonReport, comparison_table
from ...report.page import Section, Table

PASS, FAIL = "pass", "fail"


@dataclass(frozen=True)
class Check:
    """`run()` returns the report; `title` names what is checked."""

    name: str
    title: str
    run: Callable[[], ComparisonReport]

    def section(self, report: ComparisonReport) -> Section:
        """The report as a section of a page."""
        return Section(self.name, self.title, [verdicts(report.comparisons), *report.blocks])


def verdicts(comparisons: Sequence[Comparison]) -> Table:
    """Comparisons as a table of a verification page."""
    return comparison_table(comparisons, ("", "expected", "obtained", "verdict"))


def pass_or_fail(what: str, expected: str, obtained: str, passed: bool) -> Comparison:
    """A comparison that passes or fails."""
    return Comparison(what, expected, obtained, PASS if passed else FAIL)
