"""What a study is: cases to run, a function that runs one, and what it makes of their results."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..parallel.sweep import Case, Task
from ..report.finding import Finding, fact_table
from ..report.page import Section

AGREES, DIFFERS, PARTLY = "yes", "no", "partly"


@dataclass(frozen=True)
class Ask:
    """What a user can choose: building, running distance [m] and limit [m] of the design study."""

    building: str = "building200"
    distance: float = 22.0
    limit: float = 0.005


@dataclass(frozen=True)
class Study:
    """`cases(ask)` are run by `task`, in any order and place; `tell(ask, values)` makes the finding.

    `quote` is what the paper says, `title` where.
    """

    name: str
    title: str
    quote: str
    cases: Callable[[Ask], list[Case]]
    task: Task
    tell: Callable[[Ask, list[Any]], Finding]

    def section(self, finding: Finding) -> Section:
        """The finding as a section of a page."""
        return Section(self.name, self.title, [fact_table(finding.facts), *finding.blocks], self.quote)
