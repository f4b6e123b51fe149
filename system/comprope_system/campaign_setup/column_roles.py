"""What a column of a logger file is, from its name, its unit and its values beside the motion of the car."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from comprope.rope.parameters import Sensor

from ..measurements.columns.column_names import plain_name
from ..measurements.units import UNITS

Floats = NDArray[np.float64]

SURE, LIKELY, GUESS = "sure", "likely", "guess"
ANSWERED, STATED = "as answered", "as stated"  # why a column has a role that somebody told
SHEAVE = re.compile(r"sheave|pulley|axle|achse|scheibe|umlenk|tension(er|ing)_w|pit_w")
TURNING = re.compile(r"speed|omega|veloc|rpm|turn|dreh|rot|gyro|_w$|^w$|drehzahl")
FORCE = re.compile(r"force|kraft|load|last|tension|zug|loadcell|_f$")
LATERAL = re.compile(r"laser|lateral|rope|seil|disp|auslenk|dist|abstand|sway|swing|_y$|^y$|lvdt|optoncdt")
SIDES = {
    "counterweight": re.compile(r"(^|_)(cw|cwt|counterweight|gegengewicht|gg)(_|$|\d)"),
    "car": re.compile(r"(^|_)(car|cab|cabin|kabine|fahrkorb|fk)(_|$|\d)"),
}
LEVELS = {
    "low": re.compile(r"low|bottom|unten|pit|lower"),
    "mid": re.compile(r"mid|mitte|centre|center"),
    "high": re.compile(r"high|top|oben|up"),
}
SAYS_NOTHING = frozenset(
    [
        "value", "values", "wert", "messwert", "data", "signal", "y", "reading", "channel", "kanal", "ch", "ai", "in", "input",
        "column", "measurement",
    ]
)  # fmt: skip
FOLLOWS = 0.95  # correlation with the car's speed of a channel that is the sheave's angular velocity
BY_SIZE = "its unit by its size"  # why a unit was taken that no file states
METRES = {"lateral_displacement": 0.5, "sheave_displacement": 5e-3}  # largest displacements that are rather metres than mm


@dataclass(frozen=True)
class Role:
    """What a column is taken for: quantity, sensor, unit and sign of a channel, how surely, and why.

    `quantity` None is no channel of its own: left out, or what other files name `same_as`. `reference` None is the usual one.
    """

    quantity: str | None
    unit: str = ""
    sensor: str | None = None
    sign: int = 1
    certainty: str = GUESS
    why: str = ""
    same_as: str | None = None
    reference: str | None = None

    @property
    def zero(self) -> str:
        """What the channel is relative to: its mean at rest before the trip, or nothing ("absolute"), unless stated otherwise."""
        return self.reference or ("absolute" if self.quantity == "sheave_angular_velocity" else "rest")

    @property
    def shown(self) -> str:
        """The role in words."""
        if self.quantity is None:
            return f"the same as {self.same_as} in other files" if self.same_as else "left out"
        return f"{self.quantity}{f' at {self.sensor}' if self.sensor else ''} [{self.unit}]{', sign -1' if self.sign < 0 else ''}"


@dataclass(frozen=True)
class Evidence:
    """Samples (n,) of a column in one run, the rolling speed of the sheave [rad/s] at them, and the unit that the file states."""

    value: Floats
    rolling: Floats
    unit: str | None


def role_of(name: str, evidence: Sequence[Evidence], sensors: Sequence[Sensor]) -> Role:
    """The role of a column from all runs that have it."""
    known = [one for one in evidence if np.isfinite(one.value).sum() > 1]
    if not known:
        return Role(None, certainty=SURE, why="no numbers")
    plain, unit = _telling(name), next((one.unit for one in known if one.unit), None)
    follows = _follows(known)
    if unit in UNITS["sheave_angular_velocity"] or (follows is not None and abs(follows[1]) > FOLLOWS and not _is_named(plain)):
        return _turning(unit, follows)
    if unit in UNITS["sheave_force"] or (unit is None and FORCE.search(plain) and not LATERAL.search(plain)):
        return _force(plain, unit)
    if unit is not None and unit not in UNITS["lateral_displacement"]:
        return Role(None, certainty=LIKELY, why=f"in {unit}")
    if SHEAVE.search(plain):
        if TURNING.search(plain) and unit is None:
            return _turning(unit, follows)
        found = _with_length(Role("sheave_displacement", certainty=LIKELY, why="by its name"), unit, known)
        if follows is not None and abs(follows[1]) > FOLLOWS:
            return replace(found, certainty=GUESS, why="by its name, but it follows the car's speed as no displacement does")
        return found
    sensor = _sensor(plain, sensors)
    if sensor or LATERAL.search(plain):
        certainty, at = (LIKELY, sensor.name) if sensor else (GUESS, None)
        found = Role("lateral_displacement", sensor=at, certainty=certainty, why="by its name")
        return _with_length(found, unit, known)
    return Role(None, certainty=GUESS, why="its name says nothing that is known here")


def reach(value: Floats) -> float:
    """How far readings (n,) lie from their median, single ones aside; 0 without numbers."""
    return float(np.nanpercentile(np.abs(value - np.nanmedian(value)), 99.0)) if np.isfinite(value).any() else 0.0


def says_nothing(name: str) -> bool:
    """Whether a name is one that many columns have, such as "Value" and "Channel 3"."""
    return plain_name(name).rstrip("0123456789").strip("_") in SAYS_NOTHING


def _telling(name: str) -> str:
    """The plain name of a column without parts of its path that say nothing: "cw_low/values"."""
    parts = [one for one in plain_name(name).split("/") if one and not says_nothing(one)]
    return "_".join(parts) or plain_name(name)


def _is_named(plain: str) -> bool:
    return bool(LATERAL.search(plain) or FORCE.search(plain) or (SHEAVE.search(plain) and not TURNING.search(plain)))


def _follows(known: Sequence[Evidence]) -> tuple[float, float] | None:
    """Ratio to the rolling speed and correlation with it over all runs; None without a moving car."""
    x = np.concatenate([one.rolling[np.isfinite(one.value)] for one in known])
    y = np.concatenate([one.value[np.isfinite(one.value)] for one in known])
    xx, yy, xy = float(x @ x), float(y @ y), float(x @ y)
    return (xy / xx, xy / (xx * yy) ** 0.5) if xx > 0.0 and yy > 0.0 else None


def _turning(unit: str | None, follows: tuple[float, float] | None) -> Role:
    """The sheave's angular velocity; its sign, and its unit where none is stated, by the car's speed over the radius."""
    seen = follows is not None and abs(follows[1]) > FOLLOWS
    sign = -1 if follows is not None and seen and follows[0] < 0.0 else 1
    if unit is not None:
        why = "by its unit, and it follows the car's speed" if seen else "by its unit"
        return Role("sheave_angular_velocity", unit, sign=sign, certainty=SURE if seen else LIKELY, why=why)
    gain = abs(follows[0]) if follows is not None and seen else 0.0
    fitting = [name for name, scale in UNITS["sheave_angular_velocity"].items() if 0.8 < gain * scale < 1.25]
    certainty, named = (LIKELY, fitting[0]) if fitting else (GUESS, "rad/s")
    return Role("sheave_angular_velocity", named, sign=sign, certainty=certainty, why="by the car's speed")


def _force(plain: str, unit: str | None) -> Role:
    side = next((one for one, pattern in SIDES.items() if pattern.search(plain)), None)
    quantity = f"{side}_end_tension" if side else "sheave_force"
    certainty = LIKELY if unit and (side or SHEAVE.search(plain)) else GUESS
    return Role(quantity, unit or "N", certainty=certainty, why="by name and unit")


def _with_length(role: Role, unit: str | None, known: Sequence[Evidence]) -> Role:
    """The role with the unit that the file states, or with one by its size."""
    if unit is not None:
        return replace(role, unit=unit, certainty=SURE if role.certainty == LIKELY else role.certainty, why="by name and unit")
    guess = "m" if max(reach(one.value) for one in known) < METRES[str(role.quantity)] else "mm"
    return replace(role, unit=guess, why=f"{role.why}; {BY_SIZE}")


def _sensor(plain: str, sensors: Sequence[Sensor]) -> Sensor | None:
    """The sensor of the model with the same name, or the only one on the side and at the level that a name states."""
    exact = [one for one in sensors if plain_name(one.name) == plain]
    if exact:
        return exact[0]
    side = next((one for one, pattern in SIDES.items() if pattern.search(plain)), None)
    level = next((one for one, pattern in LEVELS.items() if pattern.search(plain)), None)
    found = [one for one in sensors if side is None or one.side == side]
    found = [one for one in found if level is None or LEVELS[level].search(plain_name(one.name))]
    return found[0] if len(found) == 1 and (side or level) else None
