"""A card: the result of a page at a glance, with drawings, values and what to do next."""

from collections.abc import Sequence
from dataclasses import dataclass

from .heat_map import Target


@dataclass(frozen=True)
class Card:
    """`kind` stands above the title; `values` are (name, value, interval) and `facts` (name, text); `drawings` are SVG elements.

    `evidence` are (text, panel to which it leads). `command` is the next one to type, empty for none.
    """

    kind: str
    title: str
    texts: Sequence[str]
    drawings: Sequence[str]
    values: Sequence[tuple[str, str, str]]
    facts: Sequence[tuple[str, str]]
    command: str = ""
    evidence: Sequence[tuple[str, Target]] = ()
