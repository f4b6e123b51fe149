"""Mass on a spring with a counter of steps that no output shows."""

import struct
from collections.abc import Mapping
from typing import Any

from ..errors import InputError, SimulationError
from ..fmi.model_interface import ModelInterface, Variable
from .helper import WORD

_STATE = struct.Struct("<ddq")


class Spring:
    """Semi-implicit Euler; every third step has a kick that depends on the hidden counter."""

    def __init__(self, parameters: Mapping[str, Any], inputs: Mapping[str, Any], start: float) -> None:
        if parameters["spring.mass"] == parameters["spring.stiffness"]:
            raise InputError(f"spring.mass = {parameters['spring.mass']}: must differ from the stiffness; so says the toy")
        self.mass, self.stiffness = parameters["spring.mass"], parameters["spring.stiffness"]
        self.place, self.speed, self.count = parameters["spring.place"] + inputs["force"] / self.stiffness, 0.0, 0

    def step(self, time: float, dt: float, inputs: Mapping[str, Any]) -> None:
        if inputs["force"] == 666.0:
            raise SimulationError(f"the spring broke at node 3 at t = {time + dt:g} s")
        if inputs["force"] == 667.0:
            raise ZeroDivisionError("float division\nby zero")
        self.count += 1
        self.speed += dt * ((inputs["force"] - self.stiffness * self.place) / self.mass + 0.1 * (self.count % 3))
        self.place += dt * self.speed * (-1.0 if inputs["mirror"] else 1.0)
        if inputs["force"] == 668.0:
            self.place = float("nan")
        if inputs["force"] == 669.0:
            raise KeyboardInterrupt

    def outputs(self) -> Mapping[str, Any]:
        return {"place[1]": self.place, "moving": abs(self.speed) > 1e-3, "turns": self.count // 3, "word": WORD}

    def get_state(self) -> bytes:
        return _STATE.pack(self.place, self.speed, self.count)

    def set_state(self, state: bytes) -> None:
        self.place, self.speed, self.count = _STATE.unpack(state)


def interface(place: float) -> ModelInterface:
    """The toy with its mass at `place` [m] in the beginning."""
    return ModelInterface(
        name="Spring",
        description='A mass on a spring, <"toy">',
        variables=(
            Variable("spring.mass", "real", "parameter", "mass", "kg", 2.0, 0.1, 10.0, 1.0),
            Variable("spring.stiffness", "real", "parameter", "stiffness", "N/m", 0.1 + 0.2, 0.1, 1e6, 1.0),
            Variable("spring.place", "real", "parameter", "place at the start", "m", place, -1.0, 1.0, 0.1, display_unit="mm"),
            Variable("mode", "integer", "parameter", "does nothing", start=1, minimum=0, maximum=3),
            Variable("label", "string", "parameter", "does nothing", start="ä <x>"),
            Variable("force", "real", "input", "force on the mass", "N", 0.0, nominal=10.0),
            Variable("mirror", "boolean", "input", "move the other way", start=False),
            Variable("place[1]", "real", "output", "place of the mass", "m", nominal=0.1, display_unit="mm"),
            Variable("moving", "boolean", "output", "is it moving"),
            Variable("turns", "integer", "output", "thirds of steps"),
            Variable("word", "string", "output", "what the helper says"),
        ),
        create=Spring,
        stop_time=1.0,
        step_size=0.01,
    )
