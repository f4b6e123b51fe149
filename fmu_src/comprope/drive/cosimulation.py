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
from ..fmi.model_interface import ModelInterface, Variable, parameters_of
from ..validation_messages import validation_problems
from .parameters import Drive
from .simulator import TENSIONS, DriveSimulator, input_problems, torque_problems
from .stability_margins import unstable_positions
from .trajectory.reference_trajectory import first_trajectory

NAME = "ElevatorDrive"
TORQUE = "motor_torque"  # the output
# Source of the entry module in the FMU, which creates the interface.
ENTRY = """\
from .drive.cosimulation import interface

INTERFACE = interface()
"""
_DESCRIPTION = "Elevator drive: jerk-limited trips, position and speed servo, car and counterweight on elastic hoist ropes"
_PICTURES = tuple(Path(__file__).with_name("pictures") / f"{name}.svg" for name in ("elevator", "trip"))
_REST_AFTER = 5.0  # s after the first trip, for the default stop time
_REAL_OUTPUTS = (  # name, unit, nominal, help
    ("car_position", "m", 10.0, "car height above the bottom landing"),
    ("car_velocity", "m/s", 1.0, "car velocity, up positive"),
    ("car_acceleration", "m/s2", 1.0, "car acceleration, up positive"),
    ("counterweight_position", "m", 10.0, "counterweight height above the bottom landing"),
    ("counterweight_velocity", "m/s", 1.0, "counterweight velocity, up positive"),
    ("counterweight_acceleration", "m/s2", 1.0, "counterweight acceleration, up positive"),
    ("encoder_position", "m", 10.0, "car height from the encoder on the traction sheave, without rope elongation"),
    (TORQUE, "N.m", 1000.0, "torque of the motor, positive when it moves the car up"),
    ("reference_position", "m", 10.0, "reference of the car height"),
    ("reference_velocity", "m/s", 1.0, "reference of the car velocity, up positive"),
    ("reference_acceleration", "m/s2", 1.0, "reference of the car acceleration, up positive"),
)
_FLAGS = (
    ("moving", "a trip is in progress: the reference is moving"),
    ("trip_finished", "the last trip is finished: the reference is at rest at its destination"),
)


def interface(drive: Drive | None = None) -> ModelInterface:
    """The drive as a model interface; parameters have the start values of `drive`, by default the declared ones."""
    chosen = drive or Drive()
    stop_time = ceil(first_trajectory(chosen).end_time + _REST_AFTER)
    variables = _parameters(chosen) + _inputs(chosen) + _outputs()
    return ModelInterface(NAME, _DESCRIPTION, variables, create, stop_time=float(stop_time), pictures=_PICTURES)


def create(parameters: Mapping[str, Any], inputs: Mapping[str, Any], start_time: float) -> DriveSimulator:
    """Simulator of a drive at rest at `start_time` [s], from values by name as declared by `interface`.

    Raises `InputError` with one sentence for each problem: unknown, impossible or inconsistent values, a torque limit too
    low to hold the car, unstable servo gains.
    """
    drive = drive_from_parameters(parameters)
    found = input_problems(drive, inputs) + _start_problems(drive, start_time)
    found = found or torque_problems(drive, inputs) + _gain_problems(drive)
    if found:
        raise InputError("; ".join(found))
    return DriveSimulator(drive, inputs, start_time)


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


def _start_problems(drive: Drive, start_time: float) -> list[str]:
    first = drive.trip.start_time
    if first >= start_time:
        return []
    return [f"trip.start_time = {first} s: the start of the simulation, {start_time} s, or later is accepted"]


def _gain_problems(drive: Drive) -> list[str]:
    swinging = unstable_positions(drive)
    if not swinging:
        return []
    servo = drive.servo
    return [
        f"servo.position_bandwidth = {servo.position_bandwidth} rad/s, servo.speed_bandwidth = {servo.speed_bandwidth} rad/s, "
        f"servo.speed_damping = {servo.speed_damping}, servo.sample_period = {servo.sample_period} s: unstable with the car at "
        f"{' and '.join(f'{x:g} m' for x in swinging)}; gains are accepted that keep the loop stable, such as a lower "
        "bandwidth and position_bandwidth at most a quarter of speed_bandwidth"
    ]


def _parameters(drive: Drive) -> tuple[Variable, ...]:
    parts = ((name, getattr(drive, name)) for name in Drive.model_fields)
    return tuple(variable for name, part in parts for variable in parameters_of(name, type(part), part.model_dump()))


def _inputs(drive: Drive) -> tuple[Variable, ...]:
    help_text = (
        "tension of one compensation rope at its {} end, down; the first values that are not zero belong to the equilibrium"
    )
    tensions = (
        Variable(f"{end}_end_tension", "real", "input", help_text.format(end), "N", 0.0, -1e6, 1e6, 1000.0)
        for end in ("car", "counterweight")
    )
    call = "height to which a change of this input calls the car when it is at rest; the initial value is not a call"
    return (Variable("destination", "real", "input", call, "m", drive.trip.destination, 0.0, 1000.0, 10.0), *tensions)


def _outputs() -> tuple[Variable, ...]:
    """All outputs; of the inputs, only the tensions change any of them at the start: they load the motor that holds the car."""
    numbers = (
        Variable(name, "real", "output", help, unit, nominal=nominal, initial_depends_on=TENSIONS if name == TORQUE else ())
        for name, unit, nominal, help in _REAL_OUTPUTS
    )
    return (*numbers, *(Variable(name, "boolean", "output", help, initial_depends_on=()) for name, help in _FLAGS))
