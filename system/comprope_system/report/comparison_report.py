"""Report of a study or a check: values compared with what was stated or expected, and what shows them."""

from collections.abc import Sequence
from dataclasses import dataclass

from .page import Block, Table


@dataclass(frozen=True)
class Comparison:
    """A stated or expected value and the one obtained; `verdict` is yes, no, partly, pass or fail."""

    what: str
    stated: str
    obtained: str
    verdict: str


@dataclass(frozen=True)
class ComparisonReport:
    """Facts, followed by paragraphs, tables and figures."""

    comparisons: Sequence[Comparison]
    blocks: Sequence[Block]


def comparison_table(
    comparisons: Sequence[Comparison], head: tuple[str, str, str, str] = ("", "stated", "obtained", "agrees")
) -> Table:
    """Comparisons as a table."""
    return Table(head, [(one.what, one.stated, one.obtained, one.verdict) for one in comparisons])
