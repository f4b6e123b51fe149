"""FMI variables of the rope: parameters, inputs and outputs, from the declarations of the model."""

from typing import Any

from ...fmi.model_interface import Kind, Terminal, Variable, parameters_of
from ..effects import REGISTRY, names_of
from ..parameters import Base
from ..parameters.parameter_vector import COMPONENTS
from .rope import values_of

ENDS = ("car", "counterweight")
# The inputs that a rope at rest depends on; velocities and accelerations matter from the first step.
_PLACES = (*(f"{end}_position" for end in ENDS), *(f"{end}_lateral_displacement" for end in ENDS))
_OUTPUTS = (  # name, unit, nominal, help
    ("sheave_force", "N", 1000.0, "vertical force of one rope on the sheave, up positive; its share of the weight when at rest"),
    ("sheave_displacement", "m", 0.01, "height of the axle above where it is built, up positive"),
    ("sheave_velocity", "m/s", 0.01, "vertical velocity of the sheave, up positive"),
    ("sheave_angle", "rad", 100.0, "angle of the sheave, positive while the car goes up"),
    ("sheave_angular_velocity", "rad/s", 5.0, "angular velocity of the sheave, positive while the car goes up"),
    ("car_end_tension", "N", 1000.0, "vertical pull of the rope on the car"),
    ("counterweight_end_tension", "N", 1000.0, "vertical pull of the rope on the counterweight"),
    ("car_side_max_displacement", "m", 0.05, "largest outward displacement on the car's side, above the axle"),
    ("car_side_max_height", "m", 10.0, "height of that displacement above the bottom landing"),
    (
        "counterweight_side_max_displacement",
        "m",
        0.05,
        "largest outward displacement on the counterweight's side, above the axle",
    ),
    ("counterweight_side_max_height", "m", 10.0, "height of that displacement above the bottom landing"),
    ("energy_residual", "J", 1.0, "energy balance: stored energy - initial value - work + losses; zero for exact integration"),
)
_COUNTS = (
    ("newton_iterations", "Newton iterations since the start"),
    ("halvings", "time steps halved since the start, because they did not converge"),
)
_TENSIONS = (
    ("slack_length", "m", 1.0, "length of rope that is slack: its force is a compression, of which it carries next to none"),
    ("slack_duration", "s", 1.0, "time since the start during which some of the rope was slack"),
    ("least_element_tension", "N", 1000.0, "least tension along the rope"),
    ("largest_element_tension", "N", 1000.0, "largest tension along the rope"),
    ("peak_element_tension", "N", 1000.0, "largest tension along the rope since the start, at every time step"),
)


# What dissipates energy and stores none: a change between steps leaves shape and motion as they are.
TUNABLE = (
    "rope.axial_damping", "rope.bending_damping", "rope.external_damping", "contact.damping", "contact.friction_coefficient",
)  # fmt: skip

_MOTION = (f"{end}_{rate}" for end in ENDS for rate in ("position", "velocity", "acceleration"))
TERMINAL = Terminal(
    "ends", "motion of the rope's ends, and what it pulls there", (*_MOTION, *(f"{end}_end_tension" for end in ENDS))
)


def variables_of(model: Base) -> tuple[Variable, ...]:
    """All variables of the rope; parameters start at the values of `model`, sensors are as many as its."""
    return (*_parameters(model), *_inputs(model), *_outputs(len(model.sensors)))


def _parameters(model: Base) -> tuple[Variable, ...]:
    values = values_of(model)
    groups: dict[str, type[Any]] = COMPONENTS | {f"effects.{name}": REGISTRY[name] for name in names_of(model)}
    own = {
        key: {name.rpartition(".")[2]: value for name, value in values.items() if name.startswith(f"{key}.")} for key in groups
    }
    variables = tuple(one for key, component in groups.items() for one in parameters_of(key, component, own[key], TUNABLE))
    return (*variables, *_sensor_parameters(model), *_options())


def _sensor_parameters(model: Base) -> tuple[Variable, ...]:
    found: list[Variable] = []
    names = ", ".join(sensor.name for sensor in model.sensors)
    for k, sensor in enumerate(model.sensors, 1):
        help = f"height of sensor {k} ({sensor.name}) above the bottom landing; negative in the pit"
        heights = f"heights of the sensors ({names}) above the bottom landing; negative in the pit"
        height = Variable(
            f"sensors[{k}].height", "real", "parameter", help, "m", sensor.height, -20.0, 1000.0, 10.0, array=heights
        )
        found.append(height)
        side = f"sensor {k} looks at the counterweight's side; false: at the car's"
        start, sides = sensor.side == "counterweight", "each sensor looks at the counterweight's side; false: at the car's"
        found.append(Variable(f"sensors[{k}].on_counterweight_side", "boolean", "parameter", side, start=start, array=sides))
    return tuple(found)


def _options() -> tuple[Variable, ...]:
    derivatives = "velocity and acceleration inputs are connected; false: they are found from the positions"
    at_end = (
        "inputs hold for the end of the communication step, as when the drive steps first; "
        "false: for its start, as FMI has it, and are extrapolated"
    )
    return (
        Variable("derivative_inputs", "boolean", "parameter", derivatives, start=False),
        Variable("inputs_at_end", "boolean", "parameter", at_end, start=False),
    )


def _inputs(model: Base) -> tuple[Variable, ...]:
    height = model.shaft.height
    at = {"car": 0.0, "counterweight": height}
    positions = [
        Variable(
            f"{end}_position", "real", "input", f"height of the rope's end under the {end}", "m", at[end], -20.0, 1100.0, height
        )
        for end in ENDS
    ]
    rates = [
        Variable(
            f"{end}_{word}", "real", "input", f"{word} of that end, up positive; see derivative_inputs", unit, 0.0, nominal=1.0
        )
        for end in ENDS
        for word, unit in (("velocity", "m/s"), ("acceleration", "m/s2"))
    ]
    outward = [
        Variable(f"{end}_lateral_displacement", "real", "input", "outward displacement of that end", "m", 0.0, -5.0, 5.0, 0.01)
        for end in ENDS
    ]
    base = "acceleration of the building's base towards the counterweight's side; displacements are those relative to the base"
    return (*positions, *rates, *outward, Variable("base_acceleration", "real", "input", base, "m/s2", 0.0, -50.0, 50.0, 1.0))


def _outputs(sensors: int) -> tuple[Variable, ...]:
    seen: list[Variable] = []
    for k in range(1, sensors + 1):
        help = f"outward displacement of the rope at sensor {k}, from the vertical through the sheave's side"
        all_of = "outward displacement of the rope at each sensor, from the vertical through the sheave's side"
        name = f"lateral_displacement[{k}]"
        seen.append(_output(name, "real", help, "m", nominal=0.05, display_unit="mm", array=all_of))
        gap = f"the rope passes sensor {k}; false: its end has passed, and the displacement is that of the end"
        gaps = "the rope passes each sensor; false: its end has passed, and the displacement is that of the end"
        seen.append(_output(f"in_view[{k}]", "boolean", gap, array=gaps))
    numbers, tensions = (
        [_output(name, "real", help, unit, nominal=nominal) for name, unit, nominal, help in group]
        for group in (_OUTPUTS, _TENSIONS)
    )
    switch = (
        _output("limit_switch", "boolean", "the sheave's limit switch has tripped, at a travel of sheave.limit_switch"),
        _output("limit_switch_time", "real", "time at which it tripped; -1 if it has not", "s", nominal=1.0),
    )
    return (*seen, *numbers, *(_output(name, "integer", help) for name, help in _COUNTS), *tensions, *switch)


def _output(name: str, kind: Kind, help: str, unit: str = "1", **others: Any) -> Variable:
    return Variable(name, kind, "output", help, unit, initial_depends_on=_PLACES, **others)
