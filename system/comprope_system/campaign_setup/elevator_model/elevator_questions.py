"""Questions about the elevator, from whose answers a model is estimated: rope, shaft, sheave and sensors."""

import re
from typing import Any

from pydantic import ValidationError

from comprope.errors import InputError
from comprope.rope.parameters import Sensor, Shaft, Sheave
from comprope.validation_messages import accepted, validation_problems

from ...measurements.files.raw_table import printable
from ...presets import model_path, names
from ..questions import LEFT_OUT, Ask, answered, asked_number, share_of
from .rope_catalogue import catalogue_rope

ROPE = re.compile(r"(?P<diameter>\d+(?:[.,]\d+)?)\s*(?:mm)?[\s:;,]+(?P<construction>\d.*)")
WHERE = "elevator"
MOST_SENSORS = 20
TYPICAL = {"height": 50.0, "pit": 1.5, "mass": 120.0, "diameter": 0.8}  # of the test tower, offered as defaults
WHAT_ROPE = "diameter [mm] and construction of its rope, such as 16 mm 8x19-FC"


def asked_model(default: str, ask: Ask) -> str | dict[str, Any]:
    """The name of a preset or the path of a model file, or the tables of a data sheet, as answered."""

    def read(answer: str) -> str | dict[str, Any]:
        match = ROPE.fullmatch(answer)
        if match is None:
            model_path(answer)
            return answer
        diameter = 1e-3 * float(match["diameter"].replace(",", "."))
        catalogue_rope(diameter, match["construction"])
        return {"rope": {"diameter": diameter, "construction": match["construction"]}}

    question = f"Model of the {WHERE}: a model file, a preset ({', '.join(names())}), or {WHAT_ROPE}"
    found = answered(question, default, read, ask)
    return found if isinstance(found, str) else {**found, **_shaft_and_sheave(ask), "sensors": _sensors(ask)}


def _shaft_and_sheave(ask: Ask) -> dict[str, Any]:
    height = asked_number(WHERE, Shaft, "height", "travel from bottom to top landing", TYPICAL["height"], ask)
    pit = asked_number(WHERE, Shaft, "pit", "sheave axle below the rope's end at the bottom landing", TYPICAL["pit"], ask)
    ropes = asked_number(WHERE, Sheave, "ropes", "ropes on the sheave", 1.0, ask)
    mass = asked_number(WHERE, Sheave, "mass", f"mass of the sheave, {share_of(ropes)}", TYPICAL["mass"] * ropes, ask)
    radius = asked_number(
        WHERE, Sheave, "radius", "radius of the sheave to the rope's centre line", 0.5 * TYPICAL["diameter"], ask
    )
    return {"shaft": {"height": height, "pit": pit}, "sheave": {"mass": mass, "radius": radius, "ropes": ropes}}


def _sensors(ask: Ask) -> list[dict[str, Any]]:
    """Sensors of lateral displacement, until there is no further one."""
    found: list[dict[str, Any]] = []
    what = "NAME SIDE HEIGHT, such as cw_low counterweight 0.5 [m above the bottom landing]"
    question = f"{WHERE}: a sensor of lateral displacement, {what}"
    while len(found) < MOST_SENSORS:
        one = answered(question, LEFT_OUT, _sensor, ask)
        if one is None:
            break
        found.append(one)
    return found


def _sensor(answer: str) -> dict[str, Any] | None:
    """The table of a sensor; None for the answer that there is none."""
    if answer == LEFT_OUT:
        return None
    words = answer.split()
    if len(words) != 3:
        raise InputError(f"{printable(answer)}: a name, car or counterweight, and a height are accepted")
    try:
        table = {"name": words[0], "side": words[1], "height": float(words[2])}
        Sensor.model_validate(table)
    except ValidationError as error:
        raise InputError("; ".join(validation_problems(error, Sensor))) from None
    except ValueError:
        raise InputError(f"{printable(answer)}: {accepted(Sensor, 'height')}") from None
    return table
