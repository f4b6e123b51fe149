"""The sample rate that lines above a table state."""

import re
from collections.abc import Iterable, Sequence

from .dialect import Cells

_FREQUENCIES = {"hz": 1.0, "khz": 1e3, "s/s": 1.0, "ks/s": 1e3, "sps": 1.0, "ksps": 1e3, "samples/s": 1.0, "1/s": 1.0}
_INTERVALS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}
_NUMBER = r"(?P<number>\d+(?:[.,]\d+)?(?:e[+-]?\d+)?)"


def _stated(names: str, units: Iterable[str]) -> re.Pattern[str]:
    """A number after one of the names, and a unit before it in brackets or behind it."""
    unit = "|".join(sorted(map(re.escape, units), key=len, reverse=True))
    before = rf"(?:[(\[]\s*(?P<before>{unit})\s*[)\]]\W*)?"
    return re.compile(rf"(?:{names})\W*{before}{_NUMBER}\W*(?P<unit>(?:{unit})\b)?", re.IGNORECASE)


_RATE = _stated(
    r"sampl\w*[ _-]?(?:rate|freq\w*)|scan[ _-]?rate|data[ _-]?rate|abtast(?:rate|frequenz)|messrate|\bfs", _FREQUENCIES
)
_INTERVAL = _stated(
    r"delta[ _]?[xt]|\bdt|sampl\w*[ _-]?(?:interval|period|time)|abtast(?:intervall|zeit)|\binterval", _INTERVALS
)


def stated_rate(rows: Sequence[Cells]) -> float | None:
    """Samples per second that the lines above a table state, as a rate or as an interval; None if they state none, or several."""
    found = set()
    for row in rows:
        text = " ".join(row)
        if match := _RATE.search(text):
            found.add(_number(match["number"]) * _FREQUENCIES[(match["unit"] or match["before"] or "hz").lower()])
        elif match := _INTERVAL.search(text):
            interval = _number(match["number"]) * _INTERVALS[(match["unit"] or match["before"] or "s").lower()]
            found |= {1.0 / interval} if interval > 0.0 else set()
    rates = {rate for rate in found if rate > 0.0}
    return rates.pop() if len(rates) == 1 else None


def _number(text: str) -> float:
    return float(text.replace(",", "."))
