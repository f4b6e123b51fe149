"""Derivatives over a communication step, by repeating it from a saved state as an importer can, are those of the tangent."""

from collections.abc import Iterator

import numpy as np
import pytest

from comprope.fmi.instance import Instance
from comprope.rope.simulator.cosimulation import RopeSimulator
from comprope.rope.simulator.sensitive_rope import SensitiveRope

from .native_fmu import tower

DT, BEFORE = 0.01, 40  # s; steps before the one that is repeated
MOVES = {"car_position": 1e-5, "car_velocity": 1e-3, "car_acceleration": 0.1, "counterweight_position": 1e-5}
SEEN = ["car_end_tension", "counterweight_end_tension", "sheave_displacement", "lateral_displacement[1]"]


def inputs(time: float) -> dict[str, float]:
    """Ends that start smoothly."""
    height, speed, acceleration = 0.4 * time**3, 1.2 * time**2, 2.4 * time
    ends = {"car": (height, speed, acceleration), "counterweight": (50.0 - height, -speed, -acceleration)}
    return {
        f"{end}_{what}": value
        for end, values in ends.items()
        for what, value in zip(("position", "velocity", "acceleration"), values, strict=True)
    }


class Importer:
    """An instance whose values have names."""

    def __init__(self) -> None:
        self.instance = Instance(tower())
        self.places = {one.name: place for place, one in enumerate(tower().variables)}
        self.instance.set_values("boolean", [self.places[name] for name in ("derivative_inputs", "inputs_at_end")], [True, True])

    def set(self, values: dict[str, float]) -> None:
        self.instance.set_values("real", [self.places[name] for name in values], list(values.values()))

    def get(self, names: list[str]) -> np.ndarray:
        return np.array(self.instance.get_values("real", [self.places[name] for name in names]), float)


@pytest.fixture(scope="module")
def importer() -> Iterator[Importer]:
    made = Importer()
    made.set(inputs(0.0))
    made.instance.exit_initialization()
    for k in range(1, BEFORE + 1):
        made.set(inputs(k * DT))
        made.instance.do_step((k - 1) * DT, DT)
    yield made


def by_repetition(importer: Importer, name: str) -> np.ndarray:
    """Central difference of the outputs at the end of the next step."""
    saved, last, found = importer.instance.save_state("one"), inputs((BEFORE + 1) * DT), []
    for sign in (1.0, -1.0):
        importer.set(last | {name: last[name] + sign * MOVES[name]})
        importer.instance.do_step(BEFORE * DT, DT)
        found.append(importer.get(SEEN))
        importer.instance.restore_state(saved, "one")
    return (found[0] - found[1]) / (2.0 * MOVES[name])


def by_tangent(importer: Importer, name: str) -> np.ndarray:
    """The same from the tangent of the time steps; the path of an end is linear in its inputs."""
    simulator, last = importer.instance.simulator, inputs((BEFORE + 1) * DT)
    assert isinstance(simulator, RopeSimulator)
    memory, paths = simulator.motion.to_bytes(), []
    for change in (0.0, MOVES[name], -MOVES[name]):
        paths.append(simulator.motion.path(BEFORE * DT, DT, last | {name: last[name] + change})[0])
        simulator.motion.from_bytes(memory)
    sensitive = SensitiveRope(simulator.rope.model, {name: {"contact.friction_coefficient": 0.0}}, exact=True)
    sensitive.rope.state.from_bytes(simulator.rope.state.to_bytes())
    sensitive.step(DT, paths[0], (paths[1] - paths[2])[None] / (2.0 * MOVES[name]))
    forces, sheave = sensitive.forces(), sensitive.sheave()["sheave_displacement"]
    tensions = [forces[name][0] for name in ("car_end_tension", "counterweight_end_tension")]
    return np.array([*tensions, sheave[0], sensitive.lateral_displacement()[0, 0]])


@pytest.mark.parametrize("name", MOVES)
def test_a_repeated_step_gives_the_derivative_by_an_input(importer: Importer, name: str) -> None:
    repeated, tangent = by_repetition(importer, name), by_tangent(importer, name)
    assert repeated == pytest.approx(tangent, rel=1e-3)
