"""Results of a study or check: expected and obtained values, with the text, tables and figures that support them."""

from collections.abc import Sequence
from dataclasses import dataclass

from .page import Block, Table


@dataclass(frozen=True)
class Fact:
    """A stated or expected value and the one obtained; `verdict` is yes, no, partly, pass or fail."""

    what: str
    stated: str
    obtained: str
    verdict: str


@dataclass(frozen=True)
class Finding:
    """Facts, followed by paragraphs, tables and figures."""

    facts: Sequence[Fact]
    blocks: Sequence[Block]


def fact_table(facts: Sequence[Fact], head: tuple[str, str, str, str] = ("", "stated", "obtained", "agrees")) -> Table:
    """Facts as a table."""
    return Table(head, [(one.what, one.stated, one.obtained, one.verdict) for one in facts])
