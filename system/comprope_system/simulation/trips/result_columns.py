"""Columns of a simulated trip: name, unit, description, and the output it comes from."""

from collections.abc import Sequence
from dataclasses import dataclass

from comprope.errors import InputError


@dataclass(frozen=True)
class Column:
    """One column: `output` of the participant `source`."""

    name: str
    unit: str
    help: str
    source: str
    output: str


def _motion(name: str, unit: str, help: str) -> Column:
    return Column(name, unit, help, "motion", name)


def _rope(name: str, unit: str, help: str) -> Column:
    return Column(name, unit, help, "rope", name)


MOTION = (
    _motion("car_position", "m", "height of the car above the bottom landing"),
    _motion("car_velocity", "m/s", "up positive"),
    _motion("car_acceleration", "m/s2", "up positive"),
    _motion("counterweight_position", "m", "height of the counterweight above the bottom landing"),
)
TRIP = (
    _motion("counterweight_acceleration", "m/s2", "up positive"),
    _motion("car_hoist_tension", "N", "tension of all hoist ropes on the car's side"),
    _motion("counterweight_hoist_tension", "N", "tension of all hoist ropes on the counterweight's side"),
    _motion("traction_slip", "m", "slip of the hoist ropes on the traction sheave, positive towards a rising car"),
    _motion("hoist_rope_slack", "1", "1 while the hoist ropes are slack on one side"),
)
TORQUE = _motion("motor_torque", "N.m", "torque of the drive's motor")
ROPE = (
    _rope("sheave_displacement", "m", "of the sheave's axle from `pit` below the bottom landing, up positive"),
    _rope("sheave_velocity", "m/s", "of the sheave's axle, up positive"),
    _rope("sheave_angle", "rad", "turn of the sheave, positive while the car goes up"),
    _rope("sheave_angular_velocity", "rad/s", "positive while the car goes up"),
    _rope("sheave_force", "N", "force of one rope on the sheave, up positive"),
    _rope("car_end_tension", "N", "pull of the rope on the car"),
    _rope("counterweight_end_tension", "N", "pull of the rope on the counterweight"),
    _rope("car_side_max_displacement", "m", "largest outward displacement on the car side"),
    _rope("car_side_max_height", "m", "height at which it is, above the bottom landing"),
    _rope("counterweight_side_max_displacement", "m", "largest outward displacement on the counterweight side"),
    _rope("counterweight_side_max_height", "m", "height at which it is, above the bottom landing"),
    _rope("energy_residual", "J", "energy not accounted for; zero for an exact solution"),
    _rope("newton_iterations", "1", "Newton iterations so far"),
    _rope("halvings", "1", "time steps halved so far because they did not converge"),
    _rope("slack_length", "m", "length of rope that is slack"),
    _rope("slack_duration", "s", "time so far with slack rope"),
    _rope("least_element_tension", "N", "least tension along the rope"),
    _rope("largest_element_tension", "N", "largest tension along the rope"),
    _rope("peak_element_tension", "N", "largest tension along the rope so far, at every time step"),
    _rope("limit_switch", "1", "1 from when the sheave's limit switch has tripped"),
    _rope("limit_switch_time", "s", "time at which it tripped; -1 if it has not"),
)

BUILDING = tuple(
    Column(name, unit, help, "building", name)
    for name, unit, help in (
        ("car_lateral_displacement", "m", "of the rope's end under the car with the building, outward, relative to its base"),
        ("counterweight_lateral_displacement", "m", "the same under the counterweight"),
        ("base_acceleration", "m/s2", "of the building's base, towards the counterweight's side"),
    )
)


def columns(sensors: Sequence[str], driven: bool, moving: bool = False, tripping: bool = False) -> list[Column]:
    """Columns of a trip with these sensors, in the order of the file; `driven`: by the drive, not by measured motion;
    `moving`: in a building that moves; `tripping`: the drive trips.

    Raises `InputError` if a sensor has the name of another column.
    """
    fixed = [*MOTION, *ROPE, *([TORQUE] if driven else []), *(TRIP if tripping else ()), *(BUILDING if moving else ())]
    if taken := sorted(set(sensors) & {"time", *(one.name for one in fixed)}):
        raise InputError(f"sensors: the name {taken[0]} is that of another column; choose another name")
    lateral = [
        Column(name, "m", "lateral displacement at this sensor, outward; empty where the rope's end has passed", "rope", output)
        for name, output in zip(sensors, map(lateral_output, range(len(sensors))), strict=True)
    ]
    return [*MOTION, *lateral, *fixed[len(MOTION) :]]


def lateral_output(sensor: int) -> str:
    """The rope's output for the sensor of this index, from 0."""
    return f"lateral_displacement[{sensor + 1}]"


def view_output(sensor: int) -> str:
    """The rope's output for whether the rope is in view of the sensor of this index, from 0."""
    return f"in_view[{sensor + 1}]"
