"""The rope as a model for co-simulation: its variables, and the simulator made from their values."""

from collections.abc import Mapping
from functools import partial
from math import cos, pi
from pathlib import Path
from typing import Any

from ...fmi.model_interface import ModelInterface, Value, Variable, parameters_of
from ..effects import REGISTRY, names_of
from ..model_file import validated
from ..parameters import Base
from ..runtime.parameter_vector import COMPONENTS, DECLARED
from .end_motion import EndMotion
from .rope import CompensationRope, values_of

NAME = "CompensationRope"
# What makes the interface inside an FMU, from the files of `model_file.bundle`. Who built it has consented to run them.
ENTRY = """\
from .rope.simulator.cosimulation import interface
from .rope.model_file import load

INTERFACE = interface(load(HERE / "model.toml", allow_code=True))
"""
_DESCRIPTION = (
    "Elevator compensation rope on a free sheave: lateral displacement at sensors and sheave force, from the car's and "
    "the counterweight's positions"
)
_PICTURES = tuple(Path(__file__).with_name("pictures") / f"{name}.svg" for name in ("shaft", "sheave", "element", "ends"))
_ENDS = ("car", "counterweight")
_RISE, _RISE_TIME = 2.0, 4.0  # m, s, of the run kept as a reference
_STEP = 0.01  # s, communication step that an importer uses when told nothing else
_OUTPUTS = (  # name, unit, nominal, help
    ("sheave_force", "N", 1000.0, "vertical force of the rope on the sheave, up positive; its weight when at rest"),
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


def interface(model: Base) -> ModelInterface:
    """Variables and maker of the rope; parameters start at the values of `model`, sensors are as many as its."""
    variables = (*_parameters(model), *_inputs(model), *_outputs(len(model.sensors)))
    make = partial(create, own_effects=tuple(getattr(model, "own_effects", ())))
    motion = partial(_ends_rising, model.shaft.height)
    return ModelInterface(NAME, _DESCRIPTION, variables, make, 30.0, _STEP, _PICTURES, motion)


def _ends_rising(height: float, time: float) -> dict[str, float]:
    """Positions [m] while the car rises by _RISE, less in a low shaft: half a cosine, from rest to rest."""
    risen = 0.5 * min(_RISE, 0.25 * height) * (1.0 - cos(pi * min(time / _RISE_TIME, 1.0)))
    return {"car_position": risen, "counterweight_position": height - risen}


def create(
    parameters: Mapping[str, Any], inputs: Mapping[str, Any], start_time: float, own_effects: tuple[str, ...] = ()
) -> "RopeSimulator":
    """A rope at rest at `start_time` [s] from values by name, as declared by `interface`.

    `own_effects` are the model's files. Raises InputError with all problems of the values, SimulationError when no
    shape at rest is found.
    """
    return RopeSimulator(model_of(parameters, own_effects), parameters, inputs, start_time)


def model_of(parameters: Mapping[str, Any], own_effects: tuple[str, ...] = ()) -> Base:
    """The rope model that parameters such as `rope.mass_per_length` and `sensors[1].height` describe."""
    table: dict[str, Any] = {}
    for name, value in parameters.items():
        component, _, quantity = name.rpartition(".")
        if component in COMPONENTS:
            table.setdefault(component, {})[quantity] = value
    table["own_effects"] = own_effects
    table["effects"] = {name: part for name in REGISTRY if (part := _active(name, parameters))}
    table["sensors"] = [_sensor(k, parameters) for k in range(_sensors(parameters))]
    return validated(table, "parameters")


def _active(effect: str, parameters: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters of an effect; empty if all are neutral."""
    prefix = f"effects.{effect}."
    own = {name: value for name, value in parameters.items() if name.startswith(prefix)}
    changed = any(value != DECLARED[name].neutral for name, value in own.items())
    return {name.removeprefix(prefix): value for name, value in own.items()} if changed else {}


def _sensors(parameters: Mapping[str, Any]) -> int:
    return sum(name.startswith("sensors[") and name.endswith("].height") for name in parameters)


def _sensor(k: int, parameters: Mapping[str, Any]) -> dict[str, Any]:
    one = f"sensors[{k + 1}]"
    side = "counterweight" if parameters[f"{one}.on_counterweight_side"] else "car"
    return {"name": f"sensor{k + 1}", "side": side, "height": parameters[f"{one}.height"]}


class RopeSimulator:
    """Simulator of one rope with inputs and outputs by name."""

    def __init__(self, model: Base, options: Mapping[str, Any], inputs: Mapping[str, Any], start_time: float) -> None:
        self.rope = CompensationRope(model)
        self.motion = EndMotion(
            model.sheave.radius,
            inputs,
            start_time,
            derivatives=bool(options["derivative_inputs"]),
            at_end=bool(options["inputs_at_end"]),
        )
        car, counterweight = (float(inputs[f"{end}_position"]) for end in _ENDS)
        outward = (float(inputs["car_lateral_displacement"]), float(inputs["counterweight_lateral_displacement"]))
        self.rope.solve_equilibrium(car, counterweight, outward, start_time)

    def step(self, time: float, dt: float, inputs: Mapping[str, Any]) -> None:
        """Advance from `time` by `dt` [s]; raises InputError for ends out of reach, SimulationError for a lost step."""
        self.rope.check_reach(float(inputs["car_position"]), float(inputs["counterweight_position"]), time)
        self.rope.state.time[0] = time
        self.rope.step(dt, self.motion.path(time, dt, inputs))

    def outputs(self) -> Mapping[str, Value]:
        """All outputs by name at the current time."""
        return self.rope.all_outputs()

    def get_state(self) -> bytes:
        """Rope and memory of the inputs."""
        return self.motion.to_bytes() + self.rope.state.to_bytes()

    def set_state(self, state: bytes) -> None:
        """Restore what `get_state` gave."""
        self.motion.from_bytes(state[: len(self.motion)])
        self.rope.state.from_bytes(state[len(self.motion) :])


def _parameters(model: Base) -> tuple[Variable, ...]:
    values = values_of(model)
    groups: dict[str, type[Any]] = COMPONENTS | {f"effects.{name}": REGISTRY[name] for name in names_of(model)}
    own = {
        key: {name.rpartition(".")[2]: value for name, value in values.items() if name.startswith(f"{key}.")} for key in groups
    }
    variables = tuple(one for key, component in groups.items() for one in parameters_of(key, component, own[key]))
    return (*variables, *_sensor_parameters(model), *_options())


def _sensor_parameters(model: Base) -> tuple[Variable, ...]:
    found: list[Variable] = []
    for k, sensor in enumerate(model.sensors, 1):
        help = f"height of sensor {k} ({sensor.name}) above the bottom landing; negative in the pit"
        found.append(Variable(f"sensors[{k}].height", "real", "parameter", help, "m", sensor.height, -20.0, 1000.0, 10.0))
        side = f"sensor {k} looks at the counterweight's side; false: at the car's"
        found.append(
            Variable(f"sensors[{k}].on_counterweight_side", "boolean", "parameter", side, start=sensor.side == "counterweight")
        )
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
        for end in _ENDS
    ]
    rates = [
        Variable(
            f"{end}_{word}", "real", "input", f"{word} of that end, up positive; see derivative_inputs", unit, 0.0, nominal=1.0
        )
        for end in _ENDS
        for word, unit in (("velocity", "m/s"), ("acceleration", "m/s2"))
    ]
    outward = [
        Variable(f"{end}_lateral_displacement", "real", "input", "outward displacement of that end", "m", 0.0, -5.0, 5.0, 0.01)
        for end in _ENDS
    ]
    return (*positions, *rates, *outward)


def _outputs(sensors: int) -> tuple[Variable, ...]:
    seen: list[Variable] = []
    for k in range(1, sensors + 1):
        help = f"outward displacement of the rope at sensor {k}, from the vertical through the sheave's side"
        seen.append(Variable(f"lateral_displacement[{k}]", "real", "output", help, "m", nominal=0.05, display_unit="mm"))
        gap = f"the rope passes sensor {k}; false: its end has passed, and the displacement is that of the end"
        seen.append(Variable(f"in_view[{k}]", "boolean", "output", gap))
    numbers = [Variable(name, "real", "output", help, unit, nominal=nominal) for name, unit, nominal, help in _OUTPUTS]
    counts = [Variable(name, "integer", "output", help, start=None) for name, help in _COUNTS]
    return (*seen, *numbers, *counts)
