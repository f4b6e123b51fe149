"""The drive's variables: parameters, inputs and outputs, in the order in which kernels have inputs and outputs."""

from ..fmi.model_interface import Terminal, Variable, parameters_of
from .parameters import Drive

INPUTS = ("destination", "car_end_tension", "counterweight_end_tension", "brake", "safety_gear")
TENSIONS = INPUTS[1:3]
# Outputs that inputs change at the start, and these inputs.
LOADED = {"motor_torque": TENSIONS} | {f"{end}_hoist_tension": (f"{end}_end_tension",) for end in ("car", "counterweight")}
REAL_OUTPUTS = (  # name, unit, nominal, help
    ("car_position", "m", 10.0, "car height above the bottom landing"),
    ("car_velocity", "m/s", 1.0, "car velocity, up positive"),
    ("car_acceleration", "m/s2", 1.0, "car acceleration, up positive"),
    ("counterweight_position", "m", 10.0, "counterweight height above the bottom landing"),
    ("counterweight_velocity", "m/s", 1.0, "counterweight velocity, up positive"),
    ("counterweight_acceleration", "m/s2", 1.0, "counterweight acceleration, up positive"),
    ("encoder_position", "m", 10.0, "car height from the encoder on the traction sheave, without rope elongation"),
    ("motor_torque", "N.m", 1000.0, "torque of the motor, positive when it moves the car up"),
    ("reference_position", "m", 10.0, "reference of the car height"),
    ("reference_velocity", "m/s", 1.0, "reference of the car velocity, up positive"),
    ("reference_acceleration", "m/s2", 1.0, "reference of the car acceleration, up positive"),
    ("car_hoist_tension", "N", 1e4, "tension of all hoist ropes on the car's side"),
    ("counterweight_hoist_tension", "N", 1e4, "tension of all hoist ropes on the counterweight's side"),
    ("traction_slip", "m", 0.1, "slip of the hoist ropes on the traction sheave since a trip, positive towards a rising car"),
)
FLAGS = (
    ("moving", "a trip is in progress: the reference is moving"),
    ("trip_finished", "the last trip is finished: the reference is at rest at its destination"),
    ("tripped", "brake or safety gear has been applied or a buffer met: the motor is off for good"),
    ("hoist_rope_slack", "the hoist ropes are slack on one side"),
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
    levels = (
        Variable(name, "real", "input", f"{what}: 0 off, 1 applied; above 0 the motor is off for good{more}", "1", 0.0, 0.0, 1.0)
        for name, what, more in (
            ("brake", "brake of the machine", ""),
            ("safety_gear", "safety gear of the car", ", and the brake applied"),
        )
    )
    return (Variable("destination", "real", "input", call, "m", drive.trip.destination, 0.0, 1000.0, 10.0), *tensions, *levels)


def _outputs() -> tuple[Variable, ...]:
    """All outputs; of the inputs, only the tensions change any of them at the start: they load the motor that holds the car."""
    numbers = (
        Variable(name, "real", "output", help, unit, nominal=nominal, initial_depends_on=LOADED.get(name, ()))
        for name, unit, nominal, help in REAL_OUTPUTS
    )
    return (*numbers, *(Variable(name, "boolean", "output", help, initial_depends_on=()) for name, help in FLAGS))
