"""Questions about what raw files do not state: columns that were guessed, the sheave of each run, and the elevator's data."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeVar, get_args

from comprope.errors import InputError
from comprope.quantities import Component, quantities
from comprope.rope.effects import RopeModel
from comprope.rope.parameters import Sheave

from ..measurements.campaign_file import Quantity
from ..measurements.files.raw_table import printable
from ..measurements.units import UNITS
from .column_roles import ANSWERED, GUESS, SURE, Role

Ask = Callable[[str, str], str]
Answer = TypeVar("Answer")
LEFT_OUT = "-"
WHOLE = ("ropes",)  # parameters that are counted
ATTEMPTS = 3  # answers to a question until the command gives up


def asked_role(column: str, role: Role, model: RopeModel, ask: Ask) -> Role:
    """The role of a column, after a question if it was guessed."""
    if role.certainty != GUESS:
        return role
    default = role.shown if role.quantity else LEFT_OUT
    quantities, sensors = ", ".join(get_args(Quantity)), ", ".join(one.name for one in model.sensors)
    question = (
        f"{printable(column)}: what is it? ({printable(role.why)}) QUANTITY UNIT, or lateral_displacement SENSOR UNIT, or "
        f"{LEFT_OUT} to leave it out; quantities: {quantities}; sensors: {sensors}"
    )
    return answered(question, default, lambda answer: role if answer == default else _role(column, answer, role, model), ask)


def without_guess(role: Role) -> Role:
    """The role of a column that is not asked for: a guess is left out."""
    if role.certainty != GUESS or role.quantity is None:
        return role
    return Role(None, certainty=GUESS, why=f"perhaps {role.shown}, {role.why}")


def _role(column: str, answer: str, role: Role, model: RopeModel) -> Role:
    """The role that an answer states; raises `InputError` for one that cannot be."""
    if answer == LEFT_OUT:
        return Role(None, certainty=SURE, why=ANSWERED)
    words = answer.split()
    sensor = words.pop(1) if len(words) == 3 else None
    given, sensors = f"{printable(column)}: {printable(answer)}", [one.name for one in model.sensors]
    if len(words) != 2 or words[0] not in UNITS or words[1] not in UNITS[words[0]]:
        raise InputError(f"{given}: a quantity with one of its units is accepted, such as sheave_displacement mm")
    if words[0] == "lateral_displacement" and sensor not in sensors:
        raise InputError(f"{given}: a sensor of the model is accepted: {', '.join(sensors)}")
    return replace(role, quantity=words[0], unit=words[1], sensor=sensor, certainty=SURE, why=ANSWERED)


def asked_changes(file: str, model: RopeModel, ask: Ask) -> Mapping[str, object]:
    """What differs from the model in a run: mass and, of another mass, inertia of the sheave, which no file states."""
    share, shown = share_of(model.sheave.ropes), printable(file)
    mass = asked_number(shown, Sheave, "mass", f"mass of the sheave in this run, {share}", model.sheave.mass, ask)
    if mass == model.sheave.mass:
        return {}
    in_proportion = model.sheave.inertia * mass / model.sheave.mass
    inertia = asked_number(shown, Sheave, "inertia", f"moment of inertia of this sheave, {share}", in_proportion, ask)
    return {"sheave.mass": mass, "sheave.inertia": inertia}


def asked_start(file: str, model: RopeModel, ask: Ask) -> float | None:
    """The height of the car at the start of a run [m], whose column gives none; None if it is not known."""
    shown = printable(file)

    def read(answer: str) -> float | None:
        try:
            value = None if answer == LEFT_OUT else float(answer)
        except ValueError:
            value = float("nan")
        if value is not None and not 0.0 <= value <= model.shaft.height:
            accepted = f"a height from 0 to {model.shaft.height:g} m is accepted, or {LEFT_OUT} if it is not known"
            raise InputError(f"{shown}: car_start = {printable(answer)}: {accepted}")
        return value

    return answered(f"{shown}: height of the car at the start of the record, above the bottom landing [m]", LEFT_OUT, read, ask)


def share_of(ropes: float) -> str:
    """Of which part of the sheave mass and inertia are stated."""
    return "one rope's share" if ropes == 1.0 else f"carried by {ropes:g} ropes"


def asked_number(where: str, component: type[Component], name: str, what: str, default: float, ask: Ask) -> float:
    """A parameter of a component, within the range that model files accept."""
    limits = {one.name: one for one in quantities(component)}[name]
    key, unit = f"{component.__name__.lower()}.{name}", "" if limits.unit == "1" else f" [{limits.unit}]"

    def read(answer: str) -> float:
        try:
            value = float(answer)
        except ValueError:
            value = float("nan")
        if not limits.minimum <= value <= limits.maximum or (name in WHOLE and value != round(value)):
            kind = "whole number" if name in WHOLE else "number"
            accepted = f"a {kind} from {limits.minimum:g} to {limits.maximum:g}{unit} is accepted"
            raise InputError(f"{where}: {key} = {printable(answer)}: {accepted}")
        return value

    return answered(f"{where}: {what}{unit}", f"{default:g}", read, ask)


def answered(question: str, default: str, read: Callable[[str], Answer], ask: Ask) -> Answer:
    """What `read` makes of the answer; one that it refuses is asked for again, at most `ATTEMPTS` times in all."""
    for _ in range(ATTEMPTS - 1):
        answer = ask(question, default).strip()
        try:
            return read(answer)
        except InputError as error:
            question = f"{error}\n{question.splitlines()[-1]}"
    return read(ask(question, default).strip())
