"""What a study or a check found: facts side by side with what was expected, and what shows them."""

from collections.abc import Sequence
from dataclasses import dataclass

from .page import Block, Table


@dataclass(frozen=True)
class Fact:
    """Something stated or expected, and what was obtained; `verdict` is a mark: yes, no, partly, pass or fail."""

    what: str
    stated: str
    obtained: str
    verdict: str


@dataclass(frozen=True)
class Finding:
    """Facts, then paragraphs, tables and pictures."""

    facts: Sequence[Fact]
    blocks: Sequence[Block]


def fact_table(facts: Sequence[Fact], head: tuple[str, str, str, str] = ("", "stated", "obtained", "agrees")) -> Table:
    """Facts as a table."""
    return Table(head, [(one.what, one.stated, one.obtained, one.verdict) for one in facts])
