"""The drive's variables: parameters, inputs and outputs, in the order in which kernels have inputs and outputs."""

from ..fmi.model_interface import Terminal, Variable, parameters_of
from .parameters import Drive

INPUTS = ("destination", "car_end_tension", "counterweight_end_tension")
TENSIONS = INPUTS[1:]
TORQUE = "motor_torque"  # the output
REAL_OUTPUTS = (  # name, unit, nominal, help
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
FLAGS = (
    ("moving", "a trip is in progress: the reference is moving"),
    ("trip_finished", "the last trip is finished: the reference is at rest at its destination"),
)


_MOTION = (f"{end}_{rate}" for end in ("car", "counterweight") for rate in ("position", "velocity", "acceleration"))
TERMINAL = Terminal(
    "compensation_ropes", "motion of the compensation ropes' ends, and what one rope pulls there", (*_MOTION, *TENSIONS)
)


def variables_of(drive: Drive) -> tuple[Variable, ...]:
    """All variables; parameters have the start values of `drive`."""
    return _parameters(drive) + _inputs(drive) + _outputs()


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
        for name, unit, nominal, help in REAL_OUTPUTS
    )
    return (*numbers, *(Variable(name, "boolean", "output", help, initial_depends_on=()) for name, help in FLAGS))
