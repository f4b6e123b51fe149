"""Durations as IEC 61131 and ISO 8601 write them: T#1m2s40ms, PT1M2.04S."""

import re

NANOSECONDS = {"d": 86_400e9, "h": 3_600e9, "m": 60e9, "s": 1e9, "ms": 1e6, "us": 1e3, "ns": 1.0}
IEC = re.compile(r"(?:T|TIME|LT|LTIME)#(?P<sign>-?)((?:\d+(?:\.\d+)?(?:d|h|ms|m|s|us|ns)_?)+)", re.IGNORECASE)
ISO = re.compile(r"(?P<sign>-?)P(?:(\d+)D)?(?:T(?:(\d+)H)?(?:(\d+)M)?(?:(\d+(?:[.,]\d+)?)S)?)?", re.IGNORECASE)
PART = re.compile(r"(\d+(?:\.\d+)?)(d|h|ms|m|s|us|ns)", re.IGNORECASE)


def duration(text: str) -> int | None:
    """Nanoseconds of a duration; None for other texts."""
    if text[:1] not in "TtLlPp-":
        return None
    bare = text.strip()
    if match := IEC.fullmatch(bare):
        parts = [(float(number), unit.lower()) for number, unit in PART.findall(match[2])]
    elif (match := ISO.fullmatch(bare)) and any(match.groups()[1:]):
        numbers = (one and one.replace(",", ".") for one in match.groups()[1:])
        parts = [(float(one), unit) for one, unit in zip(numbers, "dhms", strict=True) if one]
    else:
        return None
    total = round(sum(number * NANOSECONDS[unit] for number, unit in parts))
    return -total if match["sign"] else total
