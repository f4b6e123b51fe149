"""Units of measured columns: what they are in SI units, and how loggers spell them."""

import re

import numpy as np

_LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254}
_FORCES = {"N": 1.0, "kN": 1e3, "kgf": 9.80665, "lbf": 4.4482216152605}
UNITS: dict[str, dict[str, float]] = {
    "lateral_displacement": _LENGTHS,
    "sheave_displacement": _LENGTHS,
    "sheave_angular_velocity": {"rad/s": 1.0, "deg/s": np.pi / 180.0, "rpm": np.pi / 30.0, "1/min": np.pi / 30.0},
    "sheave_force": _FORCES,
    "car_end_tension": _FORCES,
    "counterweight_end_tension": _FORCES,
}
MOTIONS: dict[str, dict[str, float]] = {
    "position": _LENGTHS | {"ft": 0.3048},
    "speed": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "ft/s": 0.3048, "ft/min": 0.3048 / 60.0, "km/h": 1.0 / 3.6},
    "acceleration": {"m/s2": 1.0, "cm/s2": 1e-2, "mm/s2": 1e-3, "g": 9.80665, "mg": 9.80665e-3},
}
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "d": 86400.0}
ELECTRICAL = ("V", "mV", "mA", "A", "counts", "1", "%")
_SPELLINGS = {
    "um": "µm μm Âµm micron microns mikrometer micrometer micrometre",
    "mm": "millimeter millimetre millimeters millimetres",
    "cm": "zentimeter centimeter centimetre",
    "m": "meter metre meters metres",
    "in": "inch inches zoll \"",
    "ft": "feet foot",
    "m/s": "mps m/sec m·s-1 ms-1 m*s-1 m.s-1 m/s^1", "mm/s": "mm/sec", "ft/min": "fpm", "km/h": "kmh kph",
    "m/s2": "m/s² m/s^2 m/s/s m/sec2 m/s**2 m·s-2 m*s-2", "mm/s2": "mm/s² mm/s^2", "cm/s2": "cm/s² cm/s^2 gal",
    "rad/s": "rad/sec rad·s-1 1/s s-1 rad*s-1 rad.s-1 s^-1", "deg/s": "°/s deg/sec grad/s °/sec",
    "rpm": "u/min r/min rev/min min-1 min^-1", "1/min": "/min",
    "N": "newton", "kN": "kilonewton", "kgf": "kp", "lbf": "lb-f pound-force",
    "s": "sec secs second seconds sek sekunde sekunden", "ms": "msec millisecond milliseconds millisekunden",
    "us": "µs μs usec microsecond microseconds", "ns": "nsec nanosecond nanoseconds",
    "min": "minute minutes minuten", "h": "hr hour hours std stunden", "d": "day days tage",
    "V": "volt volts", "mV": "millivolt", "A": "ampere", "mA": "milliampere",
    "counts": "count cnt digits inc incr increments pulse pulses ticks steps impulse",
    "1": "-", "%": "percent prozent", "sample": "samples index",
}  # fmt: skip
_CANONICAL = [
    *MOTIONS["position"],
    *_FORCES,
    *UNITS["sheave_angular_velocity"],
    *MOTIONS["speed"],
    *MOTIONS["acceleration"],
    *TIMES,
    *ELECTRICAL,
]
_BY_SPELLING = {one: one for one in _CANONICAL} | {
    spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings.split()
}
_BY_LOWER = {spelling.lower(): unit for spelling, unit in reversed(_BY_SPELLING.items())}
OTHER_UNITS = frozenset([
    "°c", "degc", "c", "k", "°f", "hz", "khz", "bar", "pa", "kpa", "mpa", "kg", "t", "w", "kw", "deg", "°", "rad", "nm",
    "lb",
    "n·m", "text", "bool", "string", "date", "datetime",
])  # fmt: skip
_CASE_MATTERS = ("mN", "MN", "Mm", "mM", "S", "MS", "M", "G", "H", "D", "MV", "MG")  # another unit, or none, in lower case
_BRACKETED = re.compile(r"^(.*?)\s*[\[({<]\s*([^\])}>]{1,12})\s*[\])}>]\s*$")
_AFTER_SLASH = re.compile(r"^(.*\S)\s+(?:/|in)\s+(\S{1,8})$|^(.*[^\s/])/((?:[mcuµμ]?m|m?s|k?N|rpm))$")
_AFTER_COMMA = re.compile(r"^(.*\S),\s+(\S{1,8})$")
_AFTER_SCORE = re.compile(r"^(.*[^\W_])_(mm|cm|um|ms|us|ns|m|s|rpm|mps|kN|N|rad[_/]s|m[_/]s|deg[_/]s)$")


def unit_named(text: str) -> str | None:
    """The unit that a text spells, as it is written in campaign.toml; None if it is no unit that is known here."""
    bare = text.strip().strip("[](){}<>").strip()
    if bare in _BY_SPELLING:
        return _BY_SPELLING[bare]
    return None if bare in _CASE_MATTERS else _BY_LOWER.get(bare.lower())


def is_unit(text: str) -> bool:
    """Whether a text is a unit, of whatever quantity."""
    bare = text.strip().strip("[](){}<>").strip()
    return unit_named(bare) is not None or bare.lower() in OTHER_UNITS


def split_unit(name: str) -> tuple[str, str | None]:
    """The name of a column without its unit, and the unit as written: "Laser 1 [mm]", "y (mm)", "z / mm", "z_mm"."""
    for pattern in (_BRACKETED, _AFTER_COMMA, _AFTER_SCORE, _AFTER_SLASH):
        if match := pattern.match(name):
            base, unit = [part for part in match.groups() if part is not None]
            unit = unit.replace("_", "/")
            if base.strip() and (is_unit(unit) or (pattern is _BRACKETED and unit_like(unit))):
                return base.strip(), unit
    return name, None


def unit_like(text: str) -> bool:
    """Whether a text in brackets is rather a unit that is not known here than a part of the name."""
    return "/" in text or text.startswith(("°", "µ", "μ"))
