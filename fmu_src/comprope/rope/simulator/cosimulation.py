"""The rope as a model for co-simulation: a simulator made from the values of its variables."""

from collections.abc import Mapping
from functools import partial
from math import cos, pi
from pathlib import Path
from typing import Any

from ...fmi.model_interface import ModelInterface, Value
from ..effects import REGISTRY
from ..model_file import validated
from ..parameters import Base
from ..parameters.parameter_vector import COMPONENTS, DECLARED, slot
from .end_motion import EndMotion
from .rope import CompensationRope
from .variables import ENDS, TERMINAL, TUNABLE, variables_of

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
_NAMES = ("shaft", "sheave", "element", "ends", "guides")
_PICTURES = tuple(Path(__file__).with_name("pictures") / f"{name}.svg" for name in _NAMES)
_TUNABLE_SLOTS = {name: slot(name) for name in TUNABLE}
_RISE, _RISE_TIME = 2.0, 4.0  # m, s, of the simulation kept as a reference
_STEP = 0.01  # s, default communication step of an importer


def interface(model: Base) -> ModelInterface:
    """Variables and maker of the rope; parameters start at the values of `model`, sensors are as many as its."""
    make = partial(create, own_effects=tuple(getattr(model, "own_effects", ())))
    motion = partial(_ends_rising, model.shaft.height)
    return ModelInterface(NAME, _DESCRIPTION, variables_of(model), make, 30.0, _STEP, _PICTURES, motion, (TERMINAL,))


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
        car, counterweight = (float(inputs[f"{end}_position"]) for end in ENDS)
        outward = (float(inputs["car_lateral_displacement"]), float(inputs["counterweight_lateral_displacement"]))
        self.rope.check_start(car, counterweight, start_time)
        self.rope.solve_equilibrium(car, counterweight, outward, start_time)

    def step(self, time: float, dt: float, inputs: Mapping[str, Any]) -> None:
        """Advance from `time` by `dt` [s]; a step too short for the integration of accelerations is put off to the next one.

        `inputs` may have tunable parameters as well, which then hold from this step on.
        Raises InputError for ends that jump or are out of reach, SimulationError for a lost step.
        """
        for name, k in _TUNABLE_SLOTS.items():
            self.rope.p[k] = inputs.get(name, self.rope.p[k])
        self.rope.check_reach(float(inputs["car_position"]), float(inputs["counterweight_position"]), time)
        path, duration = self.motion.path(time, dt, inputs)
        if duration > 0.0:
            self.rope.state.time[0] = time - (duration - dt)
            self.rope.step(duration, path, self.motion.base)

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
