"""Declaration of a tuning constant: its value together with unit, meaning and origin.

@dataclass(frozen=True)
class Whitening:
    bin_width: float = setting(0.05, "s", "least width of a bin", JUDGEMENT)
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

T = TypeVar("T")
JUDGEMENT = "engineering judgement"
DERIVED = "derived"
CAMPAIGNS = "campaigns of benchmarks/score_campaigns.py"


@dataclass(frozen=True)
class Setting:
    """One constant as documentation shows it."""

    name: str
    value: Any
    unit: str
    decides: str
    origin: str


def setting(value: T, unit: str, decides: str, origin: str) -> T:
    """Field of a frozen dataclass: its default value with the unit ("1": none), what it decides and where it comes from."""
    found: T = field(default=value, metadata={"unit": unit, "decides": decides, "origin": origin})
    return found


def settings_of(group: Any) -> Iterator[Setting]:
    """The constants of one group, in the order of declaration."""
    for one in fields(group):
        yield Setting(one.name, getattr(group, one.name), **one.metadata)
