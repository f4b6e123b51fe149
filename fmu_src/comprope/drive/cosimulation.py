"""The drive as a co-simulation model: its variables, and the simulator built from their values.

Car calls: the trip of the parameters `trip.*` comes first. After that a change of the input `destination` is a call. It is
served when the reference is at rest; if the input changes several times during a trip, only the last value counts. The
initial value of the input is not a call.
"""

from collections.abc import Mapping
from math import ceil
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..errors import InputError
from ..fmi.model_interface import ModelInterface
from ..validation_messages import validation_problems
from .parameters import Drive
from .simulator import DriveSimulator
from .trajectory.reference_trajectory import first_trajectory
from .variables import TERMINAL, variables_of

NAME = "ElevatorDrive"
# Source of the entry module in the FMU, which creates the interface.
ENTRY = """\
from .drive.cosimulation import interface

INTERFACE = interface()
"""
_DESCRIPTION = "Elevator drive: jerk-limited trips, position and speed servo, car and counterweight on elastic hoist ropes"
_PICTURES = tuple(Path(__file__).with_name("pictures") / f"{name}.svg" for name in ("elevator", "trip"))
_REST_AFTER = 5.0  # s after the first trip, for the default stop time


def interface(drive: Drive | None = None) -> ModelInterface:
    """The drive as a model interface; parameters have the start values of `drive`, by default the declared ones."""
    chosen = drive or Drive()
    stop_time = ceil(first_trajectory(chosen).end_time + _REST_AFTER)
    return ModelInterface(
        NAME,
        _DESCRIPTION,
        variables_of(chosen),
        create,
        stop_time=float(stop_time),
        pictures=_PICTURES,
        icon="machine",
        terminals=(TERMINAL,),
    )


def create(parameters: Mapping[str, Any], inputs: Mapping[str, Any], start_time: float) -> DriveSimulator:
    """Simulator of a drive at rest at `start_time` [s], from values by name as declared by `interface`.

    Raises `InputError` with one sentence for each problem: unknown, impossible or inconsistent values, a torque limit too
    low to hold the car, unstable servo gains.
    """
    return DriveSimulator(drive_from_parameters(parameters), inputs, start_time)


def drive_from_parameters(parameters: Mapping[str, Any]) -> Drive:
    """The drive from parameters such as `profile.speed`; raises `InputError` with all problems."""
    tables: dict[str, Any] = {}
    for name, value in parameters.items():
        component, _, quantity = name.partition(".")
        tables.setdefault(component, {})[quantity] = value
    try:
        return Drive.model_validate(tables)
    except ValidationError as error:
        raise InputError("; ".join(validation_problems(error, Drive))) from None
