"""A check of the numerics: a title, and the simulations that decide it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..report.finding import Fact, Finding, fact_table
from ..report.page import Section, Table

PASS, FAIL = "pass", "fail"


@dataclass(frozen=True)
class Check:
    """`run()` returns the finding; `title` names what is checked."""

    name: str
    title: str
    run: Callable[[], Finding]

    def section(self, finding: Finding) -> Section:
        """The finding as a section of a page."""
        return Section(self.name, self.title, [verdicts(finding.facts), *finding.blocks])


def verdicts(facts: Sequence[Fact]) -> Table:
    """Facts as a table of a verification page."""
    return fact_table(facts, ("", "expected", "obtained", "verdict"))


def judged(what: str, expected: str, obtained: str, passed: bool) -> Fact:
    """A fact that passes or fails."""
    return Fact(what, expected, obtained, PASS if passed else FAIL)
