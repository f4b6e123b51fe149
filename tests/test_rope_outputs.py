"""The rope's outputs by name, in motion between ends at different heights, against the state they are read from."""

from functools import cache
from typing import Any

import numpy as np
import pytest

from comprope.rope.model_file import with_changes
from comprope.rope.parameters import Sensor
from comprope.rope.simulator.cosimulation import interface

from .reference_rope import ReferenceRope
from .rope_tower import STUB

HEIGHT, STEP = 3.0, 0.01
SENSORS = (
    Sensor(name="high", side="counterweight", height=1.2),
    Sensor(name="low", side="car", height=0.3),
    Sensor(name="above", side="car", height=2.5),
)
MODEL = with_changes(STUB, {"shaft.height": HEIGHT, "sheave.mass": 8.0}).model_copy(update={"sensors": SENSORS})


def inputs(time: float) -> dict[str, float]:
    """The car rises from 1 m with 2 m/s2; the counterweight sinks from 2 m."""
    car = {"position": 1.0 + time**2, "velocity": 2.0 * time, "acceleration": 2.0}
    counterweight = {"position": HEIGHT - car["position"], "velocity": -car["velocity"], "acceleration": -2.0}
    return (
        {f"car_{name}": value for name, value in car.items()}
        | {f"counterweight_{name}": value for name, value in counterweight.items()}
        | {"car_lateral_displacement": 0.01, "counterweight_lateral_displacement": 0.02}
    )


@cache
def engines() -> tuple[Any, dict[str, Any], dict[str, Any]]:
    """The rope after a tenth of a second; its outputs before the first step and now."""
    face = interface(MODEL)
    parameters = {one.name: one.start for one in face.of_role("parameter")}
    engine = face.create(parameters | {"derivative_inputs": True, "inputs_at_end": True}, inputs(0.0), 0.0)
    before = dict(engine.outputs())
    for k in range(10):
        engine.step(k * STEP, STEP, inputs((k + 1) * STEP))
    return engine, before, dict(engine.outputs())


def own(engine: Any) -> ReferenceRope:
    one = engine.rope
    return ReferenceRope(one.model, one.element, one.state.q.reshape(2, -1), one.state.v.reshape(2, -1))


def test_the_outputs_are_those_declared() -> None:
    _, before, after = engines()
    assert list(before) == list(after) == [one.name for one in interface(MODEL).of_role("output")]


def test_at_rest_the_sheave_and_the_rope_hang_between_the_ends() -> None:
    """The counterweight's side is a metre longer, and its end carries that much more."""
    _, at_rest, _ = engines()
    g, rho = MODEL.shaft.gravity, MODEL.rope.mass_per_length
    total = g * (MODEL.sheave.mass + rho * MODEL.rope_length)
    assert at_rest["sheave_force"] == pytest.approx(MODEL.sheave.mass * g, abs=1e-3)
    assert at_rest["car_end_tension"] + at_rest["counterweight_end_tension"] == pytest.approx(total, abs=1e-2)
    # The loop hangs wide and unevenly, so that its sides share its weight within a newton or two.
    longer = at_rest["counterweight_end_tension"] - at_rest["car_end_tension"]
    assert longer == pytest.approx(rho * g * 1.0, rel=0.2)
    assert all(at_rest[f"sheave_{name}"] == 0.0 for name in ("velocity", "angle", "angular_velocity"))
    assert (at_rest["newton_iterations"], at_rest["halvings"]) == (0, 0)


def test_end_tensions_are_what_the_ends_hold_up() -> None:
    engine, _, now = engines()
    acceleration = engine.rope.state.a.reshape(2, -1)
    car, counterweight = -own(engine).holders(acceleration)[0]
    assert abs(car - counterweight) > 1.0  # N
    assert now["car_end_tension"] == pytest.approx(car, rel=1e-6)
    assert now["counterweight_end_tension"] == pytest.approx(counterweight, rel=1e-6)


def test_the_sheave_s_outputs_are_up_positive_and_its_force_is_the_contact_s() -> None:
    engine, _, now = engines()
    n, (q, v, a) = engine.rope.n, (getattr(engine.rope.state, name).reshape(2, -1) for name in "qva")
    assert now["sheave_force"] == pytest.approx(-own(engine).contact[0][0, -1], rel=1e-6)
    # What holds the sheave up carries its weight and accelerates it; Newton's tolerance leaves millinewtons.
    assert now["sheave_force"] == pytest.approx(MODEL.sheave.mass * (MODEL.shaft.gravity - a[0, n]), abs=0.05)
    assert now["sheave_displacement"] == MODEL.shaft.pit - q[0, n]
    assert (now["sheave_velocity"], now["sheave_angle"], now["sheave_angular_velocity"]) == (-v[0, n], q[1, n], v[1, n])
    assert now["sheave_angle"] > 1e-4  # rad: it turns with the car that rises
    assert now["sheave_angular_velocity"] > 1e-3


def test_displacements_are_outward_from_the_side_of_the_sheave() -> None:
    engine, _, now = engines()
    n, q = engine.rope.n, engine.rope.state.q.reshape(2, -1)
    lowest = int(np.argmax(q[0, :n]))
    for k, nodes, side in ((1, slice(n - 1, lowest, -1), 1.0), (2, slice(0, lowest), -1.0)):
        expected = np.interp(-SENSORS[k - 1].height, q[0, nodes], side * q[1, nodes]) - MODEL.sheave.radius
        # The straight line between two nodes 5 cm apart leaves l^2 / 8 of the curvature, below 1 1/m.
        assert now[f"lateral_displacement[{k}]"] == pytest.approx(expected, abs=4e-4)
        assert now[f"in_view[{k}]"] == 1.0
    assert (now["lateral_displacement[3]"], now["in_view[3]"]) == (pytest.approx(0.01, abs=1e-12), 0.0)  # at the car's end
    assert now["counterweight_side_max_displacement"] > 0.05  # a sheave so light lets the loop hang wide


@pytest.mark.parametrize(("name", "side"), [("car", -1.0), ("counterweight", 1.0)])
def test_the_largest_displacement_is_that_of_its_side_with_its_height(name: str, side: float) -> None:
    engine, _, now = engines()
    n, q = engine.rope.n, engine.rope.state.q.reshape(2, -1)
    above = np.flatnonzero(q[0, :n] <= q[0, n])
    best = above[np.argmax(side * q[1, above])]
    assert now[f"{name}_side_max_displacement"] == side * q[1, best] - MODEL.sheave.radius
    assert now[f"{name}_side_max_height"] == -q[0, best]


def test_the_energy_residual_is_the_balance_of_all_energies() -> None:
    engine, before, now = engines()
    energies = engine.rope.energies()
    stored = sum(own(engine).stored().values())
    rest = engine.rope.state.start[0]
    lost = sum(energies[name] for name in own(engine).losses())
    assert before["energy_residual"] == 0.0
    assert now["energy_residual"] == pytest.approx(stored - rest - energies["ends"] + lost, abs=1e-5)
    assert abs(energies["ends"]) > 0.01  # J


def test_the_counts_are_those_of_the_solver() -> None:
    engine, _, now = engines()
    count = engine.rope.state.counters
    assert now["newton_iterations"] == engine.rope.count["newton"] >= engine.rope.count["steps"] > 0
    assert now["halvings"] == engine.rope.count["halved"]
    count[3], kept = 7.0, count[3]
    assert engine.outputs()["halvings"] == engine.rope.count["halved"] == 7
    count[3] = kept
