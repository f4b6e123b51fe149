"""Times written as dates and times of day, as nanoseconds since the first of them."""

import re
from datetime import date, datetime, time, timedelta
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

STAMP = re.compile(
    r"(?:(?P<date>\d{1,4}[-./]\d{1,2}[-./]\d{1,4}|\d{8}|\d{1,2}[-. ][A-Za-z]{3}[-. ]\d{2,4})[T ,;_-]\s*)?"
    r"(?:(?P<hour>\d{1,3}):)?(?P<minute>\d{1,2}):(?P<second>\d{2})(?:[.,:](?P<part>\d{1,9}))?"
    r"\s*(?P<half>[AaPp]\.?[Mm]\.?)?\s*(?:Z|UTC|GMT|[+-]\d{2}:?\d{2})?"
)
DIGITS = re.compile(  # "20261102T091201.123Z" and "20261102091201.123"
    r"(?P<date>(?:19|20)\d{2}(?:0[1-9]|1[0-2])(?:0[1-9]|[12]\d|3[01]))[T_ -]?(?P<hour>[01]\d|2[0-3])(?P<minute>[0-5]\d)"
    r"(?P<second>[0-5]\d)(?:[.,](?P<part>\d{1,9}))?(?P<half>)(?:Z|UTC|GMT|[+-]\d{2}:?\d{2})?"
)
DAY = 86_400_000_000_000  # ns
HALF_DAY = DAY // 2
EPOCH = date(1970, 1, 1).toordinal()


def is_time_stamp(text: str) -> bool:
    """Whether a text is a time of day or a date with one."""
    return _match(text) is not None


def _match(text: str) -> re.Match[str] | None:
    bare = text.strip()
    return STAMP.fullmatch(bare) or DIGITS.fullmatch(bare)


def nanoseconds(values: pd.Series) -> tuple[NDArray[np.int64], list[int], bool]:
    """Nanoseconds (n,) of time stamps, indices of cells that are none, and whether they have dates, as those of other files may.

    Without dates they count from the midnight before the first stamp, passing over midnight; a cell that is no stamp counts as 0.
    """
    found, wrong = np.zeros(len(values), np.int64), []
    days: dict[str, int] = {}
    dated = False
    for k, value in enumerate(values):
        one = _of_cell(value, days)
        if one is None:
            wrong.append(k)
        else:
            found[k], own = one
            dated |= own
    if not dated:
        steps = np.diff(found, prepend=found[:1])
        found += DAY * np.cumsum(steps < -HALF_DAY)
    return found, wrong, dated


def _of_cell(value: Any, days: dict[str, int]) -> tuple[int, bool] | None:
    """Nanoseconds of one stamp, and whether it has a date; None if it is none."""
    if isinstance(value, datetime):
        return DAY * (value.toordinal() - EPOCH) + _clock(value.time()), True
    if isinstance(value, time):
        return _clock(value), False
    if isinstance(value, timedelta):
        return 1000 * (value // timedelta(microseconds=1)), False
    match = _match(value) if isinstance(value, str) else None
    if match is None:
        return None
    hour, half = int(match["hour"] or 0), (match["half"] or "").lower()[:1]
    if half:
        hour = hour % 12 + (12 if half == "p" else 0)
    seconds = 3600 * hour + 60 * int(match["minute"]) + int(match["second"])
    clock = 1_000_000_000 * seconds + int((match["part"] or "0").ljust(9, "0"))
    written = match["date"]
    if written is None:
        return clock, False
    if written not in days:
        days[written] = _ordinal(written)
    return DAY * days[written] + clock, True


def _clock(value: time) -> int:
    return 1000 * (value.microsecond + 1_000_000 * (value.second + 60 * (value.minute + 60 * value.hour)))


def _ordinal(written: str) -> int:
    """Number of a day since 1970; of days written month first, right only within a month, and only differences are used."""
    digits = re.sub(r"[/. ]", "-", written)
    for form in ("%Y-%m-%d", "%d-%m-%Y", "%m-%d-%Y", "%d-%m-%y", "%m-%d-%y", "%Y%m%d", "%d-%b-%Y", "%d-%b-%y"):
        try:
            return datetime.strptime(digits, form).toordinal() - EPOCH
        except ValueError:
            continue
    return 0
