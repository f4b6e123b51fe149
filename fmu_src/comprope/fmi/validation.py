"""Validation of values, steps and interfaces; each problem is one sentence for the user."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from ..errors import InputError
from .arrays import groups_of
from .model_interface import ModelInterface, Variable

_TIME_TOLERANCE = 1e-6  # of a step; importers that add up their steps drift by far less


def format_value(value: Any, unit: str) -> str:
    """A value with its unit, as in `0.5 m`."""
    text = f"{value:.6g}" if isinstance(value, float) else repr(value)
    return text if unit == "1" else f"{text} {unit}"


def range_text(variable: Variable) -> str:
    """What a variable accepts, as in `0.002 to 0.1 m is accepted`."""
    low, high = variable.minimum, variable.maximum
    if low is None and high is None:
        return "a finite number is accepted"
    unit = "" if variable.unit == "1" else f" {variable.unit}"
    if low is None or high is None:
        return f"at most {high:g}{unit} is accepted" if low is None else f"at least {low:g}{unit} is accepted"
    return f"{low:g} to {high:g}{unit} is accepted"


def finite_problem(variable: Variable, value: Any) -> str | None:
    """A sentence if the value is not a finite number where one is needed."""
    if variable.kind != "real" or math.isfinite(value):
        return None
    return f"{variable.role} {variable.name} = {value}: {range_text(variable)}"


def range_problems(variables: Iterable[Variable], values: Mapping[str, Any]) -> list[str]:
    """A sentence for each value that is not finite or not within the declared range."""
    return [sentence for one in variables if (sentence := _range_problem(one, values[one.name]))]


def _range_problem(variable: Variable, value: Any) -> str | None:
    if variable.kind not in ("real", "integer"):
        return None
    low = -math.inf if variable.minimum is None else variable.minimum
    high = math.inf if variable.maximum is None else variable.maximum
    if math.isfinite(value) and low <= value <= high:
        return None
    return f"{variable.role} {variable.name} = {format_value(value, variable.unit)}: {range_text(variable)} ({variable.help})"


def step_problem(time: float, dt: float, reached: float, stop: float | None) -> str | None:
    """A sentence if a step of `dt` from `time` is not possible when the simulation is at `reached` [s]."""
    if not (math.isfinite(dt) and dt > 0.0):
        return f"step size = {dt} s: a finite number above 0 is accepted"
    if not abs(time - reached) <= _tolerance(time, dt):
        return (
            f"step from {time!r} s: the time reached is {reached!r} s, and only a step from there is accepted; "
            "to go back, restore a saved state"
        )
    if time + dt == time:
        return f"step size = {dt:g} s: too small to change the time of {time!r} s"
    if stop is not None and time + dt > stop + _tolerance(time, dt):
        return f"step to {time + dt!r} s: the stop time was set to {stop!r} s"
    return None


def _tolerance(time: float, dt: float) -> float:
    return _TIME_TOLERANCE * dt + 8.0 * math.ulp(max(1.0, abs(time)))


def interface_problems(interface: ModelInterface) -> list[str]:
    """Problems in the declaration of a model's variables; for authors of models, while building."""
    names = [one.name for one in interface.variables]
    inputs = {one.name for one in interface.of_role("input")}
    found = [f"{name}: declared more than once" for name in sorted({name for name in names if names.count(name) > 1})]
    for one in interface.variables:
        found += [f"{one.name}: depends on {other}, which is no input" for other in one.depends_on if other not in inputs]
        at_start = one.initial_depends_on or ()
        found += [f"{one.name}: depends on {other} at the start, which is no input" for other in at_start if other not in inputs]
        if (one.start is None) != (one.role == "output"):
            found.append(f"{one.name}: parameters and inputs, and only they, have a start value")
        elif one.role != "output":
            found += range_problems([one], {one.name: one.start})
        if one.tunable and one.role != "parameter":
            found.append(f"{one.name}: only a parameter is tunable")
    try:
        groups_of(interface)
    except InputError as error:
        found.append(str(error))
    found += [
        f"terminal {terminal.name}: {name} is no variable"
        for terminal in interface.terminals
        for name in terminal.members
        if name not in names
    ]
    return found
