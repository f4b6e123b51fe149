"""Times written as dates and times of day, as nanoseconds since the first of them."""

import re
from collections.abc import Sequence
from datetime import date, datetime, time, timedelta
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from .durations import duration

STAMP = re.compile(
    r"(?:(?P<days>\d{1,5}) days?,? \+?)?"
    r"(?:(?P<date>\d{1,4}[-./]\d{1,2}[-./]\d{1,4}|\d{8}|\d{1,2}[-. ][A-Za-z]{3}[-. ]\d{2,4})[T ,;_-]\s*)?"
    r"(?:(?P<hour>\d{1,3}):)?(?P<minute>\d{1,2}):(?P<second>\d{2})(?:[.,:](?P<part>\d{1,9}))?"
    r"\s*(?P<half>[AaPp]\.?[Mm]\.?)?\s*(?:Z|UTC|GMT|(?P<zone>[+-]\d{2}:?\d{2}))?"
)
DIGITS = re.compile(  # "20261102T091201.123Z" and "20261102091201.123"
    r"(?P<date>(?:19|20)\d{2}(?:0[1-9]|1[0-2])(?:0[1-9]|[12]\d|3[01]))[T_ -]?(?P<hour>[01]\d|2[0-3])(?P<minute>[0-5]\d)"
    r"(?P<second>[0-5]\d)(?:[.,](?P<part>\d{1,9}))?(?P<half>)(?P<days>)(?:Z|UTC|GMT|(?P<zone>[+-]\d{2}:?\d{2}))?"
)
FORMS = ("%Y-%m-%d", "%d-%m-%Y", "%m-%d-%Y", "%d-%m-%y", "%m-%d-%y", "%Y%m%d", "%d-%b-%Y", "%d-%b-%y")
MINUTE = 60_000_000_000  # ns
DAY = 86_400_000_000_000  # ns
HALF_DAY = DAY // 2
EPOCH = date(1970, 1, 1).toordinal()


def is_time_stamp(text: str) -> bool:
    """Whether a text is a time of day, a date with one, or a duration."""
    return _match(text) is not None or duration(text) is not None


def _match(text: str) -> re.Match[str] | None:
    bare = text.strip()
    return STAMP.fullmatch(bare) or DIGITS.fullmatch(bare)


def nanoseconds(values: pd.Series) -> tuple[NDArray[np.int64], list[int], bool]:
    """Nanoseconds (n,) of time stamps, indices of cells that are none, and whether they have dates, as those of other files may.

    Without dates they count from the midnight before the first stamp, passing over midnight; a cell that is no stamp counts as 0.
    Where the zone changes, they go on in that of the first stamp.
    """
    found, wrong = np.zeros(len(values), np.int64), []
    matches = [_match(one) if isinstance(one, str) else None for one in values]
    days = _days([one for one in matches if one is not None])
    zones = {one["zone"]: _minutes(one["zone"]) for one in matches if one is not None and one["zone"]}
    first = next((zones[one["zone"]] for one in matches if one is not None and one["zone"]), 0)
    dated = bool(days)
    for k, (value, match) in enumerate(zip(values, matches, strict=True)):
        if match is not None:
            late = first - zones[match["zone"]] if match["zone"] else 0
            found[k] = _of_text(match) + DAY * days.get(match["date"] or "", 0) + MINUTE * late
        elif (own := _of_cell(value)) is not None:
            found[k] = own
            dated |= isinstance(value, datetime)
        else:
            wrong.append(k)
    if not dated:
        steps = np.diff(found, prepend=found[:1])
        found += DAY * np.cumsum(steps < -HALF_DAY)
    return found, wrong, dated


def _of_cell(value: Any) -> int | None:
    """Nanoseconds of a cell that is no stamp; None if it is no time."""
    if isinstance(value, datetime):
        return DAY * (value.toordinal() - EPOCH) + _clock(value.time())
    if isinstance(value, time):
        return _clock(value)
    if isinstance(value, str):
        return duration(value)
    if isinstance(value, timedelta):
        return 1000 * (value // timedelta(microseconds=1))
    return None


def _of_text(match: re.Match[str]) -> int:
    """Nanoseconds of the clock of a stamp, and of the days of a duration."""
    hour, half = int(match["hour"] or 0), (match["half"] or "").lower()[:1]
    if half:
        hour = hour % 12 + (12 if half == "p" else 0)
    seconds = 3600 * hour + 60 * int(match["minute"]) + int(match["second"])
    return DAY * int(match["days"] or 0) + 1_000_000_000 * seconds + int((match["part"] or "0").ljust(9, "0"))


def _minutes(zone: str) -> int:
    """Minutes of a zone such as +02:00."""
    return (-1 if zone.startswith("-") else 1) * (60 * int(zone[1:3]) + int(zone[-2:]))


def _clock(value: time) -> int:
    return 1000 * (value.microsecond + 1_000_000 * (value.second + 60 * (value.minute + 60 * value.hour)))


def _days(matches: Sequence[re.Match[str]]) -> dict[str, int]:
    """Days since 1970 by the dates of stamps, read in the notation with which they lie closest together.

    Of a single day, 11/02 is the second of November with AM or PM, otherwise the eleventh of February.
    """
    written = sorted({one["date"] for one in matches if one["date"]})
    american = any(one["half"] for one in matches)
    forms = sorted(FORMS, key=lambda form: form.startswith("%d-%m")) if american else FORMS
    read = [found for form in forms if (found := _ordinals(written, (form,))) is not None]
    mixed = _ordinals(written, forms)
    return min(read, key=lambda found: max(found.values()) - min(found.values())) if read and written else mixed or {}


def _ordinals(written: Sequence[str], forms: Sequence[str]) -> dict[str, int] | None:
    """Days since 1970 by date, each in the first of the forms that it has; None if one has none of them."""
    found = {}
    for one in written:
        digits = re.sub(r"[/. ]", "-", one)
        for form in forms:
            try:
                found[one] = datetime.strptime(digits, form).toordinal() - EPOCH
                break
            except ValueError:
                continue
        if one not in found:
            return None
    return found
