"""Walls beside the rope: their forces, and a string that bounces off them."""

import numpy as np
import pytest

from comprope.rope.effects import REGISTRY
from comprope.rope.effects.checks.trial_state import NODES, TrialState
from comprope.rope.parameters.parameter_vector import CAR_WALL, CAR_WALL_V, ELEMENT, R, slot
from comprope.rope.runtime.array_layout import DXX, DYY
from comprope.rope.runtime.kernel_arguments import Weights
from comprope.rope.simulator.rope import CompensationRope

from .rope_tower import TOWER, rope

WALL = {"stiffness": 1e5, "damping": 500.0, "friction_coefficient": 0.3, "distance": 0.05, "bottom": 5.0, "top": 8.0}
NODE = 60  # on the car's side


def beside_the_wall(height: float, out: float, up: float, outward: float) -> TrialState:
    """A rope at random with one node at a height, displaced outward [m] and moving up and outward [m/s]; no other one touches."""
    trial = TrialState(REGISTRY["shaft_walls"], nominal=True)
    for name, value in WALL.items():
        trial.p[slot(f"effects.shaft_walls.{name}")] = value
    q, v, m = trial.arguments["q"], trial.arguments["v"], NODES + 1
    q[m : m + NODES] *= 0.5
    q[NODE], q[m + NODE] = -height, -(trial.p[R] + out)
    v[NODE], v[m + NODE] = -up, -outward
    return trial


@pytest.mark.parametrize(("height", "out", "up", "outward", "share"), [
    (6.0, 0.051, 0.0, 0.1, 1.0), (6.0, 0.051, 2.0, 0.0, 1.0), (6.0, 0.049, 2.0, 0.3, 0.0), (4.9, 0.06, 0.0, 0.0, 0.0),
    (6.0, 0.0505, 0.0, -2.0, 0.0), (8.1, 0.06, 0.0, 0.0, 0.0),
])  # fmt: skip
def test_a_wall_pushes_inward_and_rubs_and_never_pulls(
    height: float, out: float, up: float, outward: float, share: float
) -> None:
    trial, m = beside_the_wall(height, out, up, outward), NODES + 1
    depth, length = out - 0.05, trial.p[ELEMENT]
    pressed = share * length * (1e5 * depth + 500.0 * depth / (depth + 1e-4) * outward) if share else 0.0
    f = trial.forces()
    assert f[m + NODE] == pytest.approx(pressed, rel=1e-9, abs=1e-9)  # y of the car's side is negative: inward is positive
    assert f[NODE] == pytest.approx(0.3 * pressed * up / np.hypot(up, 0.02), rel=1e-9, abs=1e-9)  # x is down
    assert np.count_nonzero(f) == (2 if pressed and up else 1 if pressed else 0)


def test_a_wall_begins_over_one_element() -> None:
    length = beside_the_wall(6.0, 0.06, 0.0, 0.0).p[ELEMENT]
    half = beside_the_wall(5.0 + 0.5 * length, 0.06, 0.0, 0.0).forces()[NODES + 1 + NODE]
    assert half == pytest.approx(0.5 * length * 1e5 * 0.01, rel=1e-6)


def test_the_tangent_is_that_of_the_force() -> None:
    trial, m = beside_the_wall(6.0, 0.053, 0.01, 0.05), NODES + 1
    for array, weights, place, section, i in (
        ("q", Weights(1.0, 0.0), m + NODE, DYY, NODE), ("v", Weights(0.0, 1.0), m + NODE, DYY, NODE),
        ("v", Weights(0.0, 1.0), NODE, DXX, NODE),
    ):  # fmt: skip

        def move(step: float, array: str = array, place: int = place) -> None:
            trial.arguments[array][place] += step

        expected = -trial.slope(move, trial.forces)[place]
        trial.arguments["A"][:], trial.arguments["weights"] = 0.0, weights
        trial.call("tangents")
        assert expected > 1.0
        assert trial.arguments["A"][section * m + i] == pytest.approx(expected, rel=1e-4)


def swung(changes: dict[str, float]) -> tuple[CompensationRope, np.ndarray]:
    """The tower's rope, whose car end swings outward by 0.2 m and back in 4 s; how far out the rope is [m] every 20 ms of 8 s."""
    one, dt, seen, period = rope(changes), 0.02, [], 4.0
    one.solve_equilibrium(45.0, 5.0)
    for k in range(400):
        path = np.zeros((4, 6))
        path[1], path[3] = [-TOWER.sheave.radius, 0, 0] * 2, [TOWER.sheave.radius, 0, 0] * 2
        path[0, [0, 3]], path[2, [0, 3]] = -45.0, -5.0
        for at, time in ((0, k * dt), (3, (k + 1) * dt)):
            t, w = min(time, period), 2.0 * np.pi / period
            turn = w * t
            path[1, at] -= 0.1 * (1.0 - np.cos(turn))
            path[1, at + 1], path[1, at + 2] = -0.1 * w * np.sin(turn), -0.1 * w * w * np.cos(turn) * (time < period)
        one.step(dt, path.ravel())
        seen.append(one.maximum("car")[0])
    return one, np.array(seen)


def test_a_rope_that_swings_bounces_off_a_wall_and_keeps_its_energy() -> None:
    """It goes no further than the wall, a bracket low in the shaft; what it loses is what the wall takes."""
    free, far = swung({})
    wall = {f"effects.shaft_walls.{key}": value for key, value in WALL.items()}
    wall |= {"effects.shaft_walls.bottom": 5.0, "effects.shaft_walls.top": 30.0, "effects.shaft_walls.distance": 0.15}
    held, near = swung(wall)
    after = slice(220, None)  # the end is at rest again
    assert far[after].max() > 0.2
    assert near[after].max() < 0.17 < far[after].max()
    assert held.energies()["effects.shaft_walls"] != 0.0
    assert abs(held.energy_residual) < 0.05 * abs(free.energies()["ends"])


def test_a_wall_that_moves_with_the_building_pushes_at_the_distance_between_them() -> None:
    """Displaced by 20 mm at the car's end, it is nearer by its share of the height above the axle; so with its velocity."""
    still, moved = (beside_the_wall(6.0, out, 0.0, outward) for out, outward in ((0.051, 0.1), (0.05, 0.0)))
    q, m = moved.arguments["q"], NODES + 1
    share = (q[NODES] - q[NODE]) / (q[NODES] - q[0])
    assert 0.2 < share < 1.0
    moved.p[CAR_WALL], moved.p[CAR_WALL_V] = 0.02, 0.3
    q[m + NODE] = -(moved.p[R] + 0.051 - share * 0.02)
    moved.arguments["v"][m + NODE] = share * 0.3 - 0.1
    assert moved.forces()[m + NODE] == pytest.approx(still.forces()[m + NODE], rel=1e-9)


def test_a_rope_in_a_leaning_building_touches_no_wall_that_leans_with_it() -> None:
    wall = {f"effects.shaft_walls.{name}": value for name, value in (("stiffness", 1e5), ("distance", 0.06))}
    found = []
    for changes in ({}, wall | {"shaft.walls_follow": 1.0}, wall):
        hung = rope(changes)
        hung.solve_equilibrium(20.0, 30.0, (-0.1, 0.1))
        found.append(np.asarray(hung.state.q).copy())
    assert np.abs(found[1] - found[0]).max() < 1e-6
    assert np.abs(found[2] - found[0]).max() > 0.01
