"""Corrections of what `comprope_system.new` takes raw files for, as somebody states them who knows."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import with_changes

from ..measurements.campaign_file import MotionColumn
from ..measurements.files.raw_table import printable
from ..measurements.units import UNITS
from .column_roles import STATED, SURE, Role

ROLES = ("fit", "validate")
REFERENCES = ("rest", "absolute")


@dataclass(frozen=True)
class Corrections:
    """What is stated: the column of the car, channels by column, the role of runs and their changes of the model by file.

    A channel is a `Role`, of which quantity, unit, sensor, sign and reference count; quantity None leaves the column out.
    """

    car: MotionColumn = field(default_factory=MotionColumn)
    columns: Mapping[str, Role] = field(default_factory=dict)
    roles: Mapping[str, str] = field(default_factory=dict)
    changes: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


def corrected(found: Mapping[str, Role], stated: Mapping[str, Role], model: RopeModel) -> dict[str, Role]:
    """The roles of columns with those that are stated; raises `InputError` with one line for each that cannot be."""
    problems = [line for name, one in stated.items() for line in _problems(name, one, found, model)]
    result = dict(found) | {name: replace(one, certainty=SURE, why=STATED, same_as=None) for name, one in stated.items()}
    places: dict[tuple[str, str | None], str] = {}
    for name, one in result.items():
        if one.quantity is None:
            continue
        first = places.setdefault((one.quantity, one.sensor), name)
        if first != name:
            problems.append(f"{printable(name)}: {one.quantity} at {one.sensor or 'the sheave'} is {printable(first)} already")
    if problems:
        raise InputError("\n".join(problems))
    return result


def _problems(name: str, one: Role, found: Mapping[str, Role], model: RopeModel) -> list[str]:
    sensors = [sensor.name for sensor in model.sensors]
    if name not in found:
        return [f"{printable(name)}: no such column; there are {', '.join(map(printable, found))}"]
    if one.quantity is None:
        return []
    if one.quantity not in UNITS:
        return [f"{printable(name)}: {printable(one.quantity)} is no quantity; accepted are {', '.join(UNITS)}"]
    if one.unit not in UNITS[one.quantity]:
        accepted = ", ".join(UNITS[one.quantity])
        return [f"{printable(name)}: unit {printable(one.unit)}: for {one.quantity} {accepted} are accepted"]
    if one.zero not in REFERENCES:
        return [f"{printable(name)}: reference {printable(one.zero)}: {', '.join(REFERENCES)} are accepted"]
    if one.quantity == "lateral_displacement" and one.sensor not in sensors:
        return [f"{printable(name)}: a sensor of the model is needed: {', '.join(sensors)}"]
    return []


def require_runs(stated: Corrections, files: list[str], model: RopeModel) -> None:
    """Raise `InputError` for roles and changes of runs that are not there or cannot be."""
    problems = [
        f"{printable(file)}: role {printable(role)}: fit or validate is accepted"
        for file, role in stated.roles.items()
        if role not in ROLES
    ]
    problems += [f"{printable(file)}: no such run" for file in {*stated.roles, *stated.changes} if file not in files]
    for file, changes in stated.changes.items():
        try:
            with_changes(model, dict(changes), printable(file))
        except InputError as error:
            problems += str(error).splitlines()
    if problems:
        raise InputError("\n".join(problems))
