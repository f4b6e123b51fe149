"""Unbalance, jammed and sticky guides, brushes and guides at the rope, and the encoder's scale, against closed forms."""

import numpy as np
import pytest

from comprope.drive.trajectory.s_curve import TrajectoryPoint
from comprope.rope.effects import REGISTRY
from comprope.rope.effects.checks.trial_state import NODES, TrialState
from comprope.rope.runtime.array_layout import DXX
from comprope.rope.runtime.kernel_arguments import Weights
from comprope.rope.simulator.rope import CompensationRope
from comprope_system.identification.prediction.effect_hypotheses import heights_tried, hypotheses_of_effect
from comprope_system.identification.prediction.model_effects import shapes_of

from .rope_tower import TOWER, rope, way

SHORT = {"shaft.height": 4.0, "rope.bending_stiffness": 2.0}
GRAVITY, RADIUS, SHEAVE = TOWER.shaft.gravity, TOWER.sheave.radius, TOWER.sheave


def of(effect: str, **values: float) -> dict[str, float]:
    """Model keys of an effect."""
    return {f"effects.{effect}.{name}": value for name, value in values.items()}


def lowered(one: CompensationRope, speed: float, steps: int, dt: float) -> None:
    """Carry the rope's ends at a speed of the car [m/s], without a jerk that the tests would see."""
    car, cw = 0.0, TOWER.shaft.height
    one.solve_equilibrium(car, cw)
    path = np.zeros((4, 6))
    path[1], path[3] = [-RADIUS, 0, 0] * 2, [RADIUS, 0, 0] * 2
    at = np.zeros(3)
    for k in range(1, steps + 1):
        s = min(k * dt / 2.0, 1.0)  # speeds up over 2 s
        rate = speed * s * s * (3.0 - 2.0 * s)
        rise = speed * 6.0 * s * (1.0 - s) / 2.0
        next_at = np.array([speed * (2.0 * (s**3 - 0.5 * s**4) + max(k * dt - 2.0, 0.0)), rate, rise])
        for entry, motion in ((0, at), (3, next_at)):
            path[0, entry : entry + 3] = -motion
            path[2, entry : entry + 3] = motion
            path[2, entry] -= TOWER.shaft.height
        one.step(dt, path.ravel())
        at = next_at


def test_an_unbalanced_sheave_that_nothing_holds_swings_as_a_pendulum() -> None:
    """theta'' = -U g sin(theta + phase) / J: half a period pi sqrt(J / (U g)) after the start it has swung to the other side."""
    unbalance, aside = 5.0, 0.1
    free = {"contact.friction_coefficient": 0.0, "shaft.height": 4.0}
    one = rope(free | of("sheave_unbalance", unbalance=unbalance, phase=aside))
    one.solve_equilibrium(2.0, 2.0)
    half, steps = np.pi * np.sqrt(SHEAVE.inertia / (unbalance * GRAVITY)) * (1.0 + aside**2 / 16.0), 100
    for _ in range(steps):
        one.step(half / steps, way(RADIUS, 4.0, *(2 * [TrajectoryPoint(2.0)])))
    assert one.sheave()["sheave_angle"] == pytest.approx(-2.0 * aside, rel=2e-3)
    assert one.sheave()["sheave_angular_velocity"] == pytest.approx(0.0, abs=2e-3)
    assert abs(one.energy_residual) < 1e-3


def test_a_jammed_seal_makes_both_sides_differ_by_its_torque() -> None:
    """k theta = (T_cw - T_car) R in steady motion, beside what the rope without it does."""
    k, found = 2.0, []
    for changes in ({}, of("jammed_seal", stiffness=k)):
        one = rope({"shaft.height": 50.0} | changes)
        lowered(one, 2.0, 250, 0.02)
        outputs = one.outputs()
        found.append((outputs["counterweight_end_tension"] - outputs["car_end_tension"], one.sheave()["sheave_angle"]))
    (before, _), (with_it, angle) = found
    assert angle == pytest.approx(8.0 / RADIUS, rel=0.01)  # 8 m of rope have rolled over it
    # The bounce that starting to move leaves, and how the rope slips a little: some per cent of 100 N.
    assert abs(with_it - before) == pytest.approx(k * angle / RADIUS, rel=0.05)


def test_a_jammed_guide_is_a_spring_beside_the_rope() -> None:
    """At rest the rope carries the weight less what the guide takes, k times how far the axle is below its place."""
    one = rope(SHORT | of("jammed_guide", stiffness=5e5))
    one.solve_equilibrium(2.0, 2.0)
    outputs = one.outputs()
    assert outputs["sheave_displacement"] < -1e-4  # m
    expected = SHEAVE.mass * GRAVITY + 5e5 * outputs["sheave_displacement"]
    assert outputs["sheave_force"] == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("speed", [1e-4, 5e-4, 1e-3, 2e-3, 5e-3, -3e-4])
def test_a_sticky_guide_breaks_away_at_more_than_it_slides_with(speed: float) -> None:
    trial = TrialState(REGISTRY["sticky_guide"], nominal=True)
    trial.arguments["v"][NODES] = speed
    size = 10.0 + 20.0 * np.exp(-((speed / 2e-3) ** 2))
    assert trial.forces()[NODES] == pytest.approx(-size * speed / np.hypot(speed, 5e-4), rel=1e-9)

    def move(step: float) -> None:
        trial.arguments["v"][NODES] += step

    slope = -trial.slope(move, trial.forces)[NODES]
    trial.arguments["weights"] = Weights(0.0, 1.0)
    trial.call("tangents")
    assert trial.arguments["A"][DXX * (NODES + 1) + NODES] == pytest.approx(max(slope, 0.0), rel=1e-3)


def leaning(changes: dict[str, float]) -> tuple[float, float]:
    """How far out the rope is 0.5 m above the bottom landing on either side, with ends that hang 50 mm further out."""
    one = rope(SHORT | of("attachment_offset", car=0.05, counterweight=0.05) | changes)
    one.solve_equilibrium(2.0, 2.0)
    return one.lateral_displacement("car", 0.5)[0], one.lateral_displacement("counterweight", 0.5)[0]


def test_a_brush_holds_the_rope_as_a_spring_between_two_spans() -> None:
    """u = u_0 / (1 + k / k_rope) with k_rope = T (1 / a + 1 / b) of a string, on its side only."""
    car, free = leaning({})
    brush = of("rope_brush", height=0.5, side=1.0, length=0.1)
    held = [leaning(brush | {"effects.rope_brush.stiffness": k}) for k in (100.0, 400.0)]
    assert all(one[0] == pytest.approx(car, abs=1e-5) for one in held)
    assert free > 0.02
    stiffness = [k / (free / one[1] - 1.0) for k, one in zip((100.0, 400.0), held, strict=True)]
    tension = 0.5 * SHEAVE.mass * GRAVITY + 2.0 * TOWER.rope.mass_per_length * GRAVITY
    # The sheave is 1.5 m below the landing: spans of 2 m and 1.5 m, whose ends bending stiffens over some centimetres.
    assert stiffness == pytest.approx(2 * [tension * (1.0 / 2.0 + 1.0 / 1.5)], rel=0.06)
    assert stiffness[0] == pytest.approx(stiffness[1], rel=0.01)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_stiff_guide_sets_where_the_rope_passes_and_leaves_one_that_does_not_touch(side: float) -> None:
    guide = of("rope_guide", stiffness=1e6, height=0.5, side=side, length=0.1)
    free, name = leaning({}), 1 if side > 0.0 else 0
    pushed, inside, beyond = (leaning(guide | {"effects.rope_guide.push": push}) for push in (0.06, 0.01, -0.01))
    assert pushed[name] == pytest.approx(0.06, abs=2e-3)
    assert inside == pytest.approx(free, abs=1e-12)  # the rope hangs further out
    assert beyond[name] == pytest.approx(-0.01, abs=2e-3)
    assert pushed[1 - name] == pytest.approx(free[1 - name], abs=1e-4)


def test_a_rope_with_an_encoder_of_another_scale_hangs_where_the_car_truly_is() -> None:
    e = 0.02
    scaled, plain = rope(of("encoder_scale", excess=e)), rope()
    scaled.solve_equilibrium(20.4, 29.6)
    plain.solve_equilibrium(20.0, 30.0)
    assert np.abs(scaled.state.q - plain.state.q).max() < 1e-9


def test_brushes_and_guides_are_tried_at_heights_of_the_shaft_and_fitted_from_there() -> None:
    heights = heights_tried(TOWER)
    assert heights == pytest.approx([1.0, 3.0, 7.0])
    brushes = hypotheses_of_effect(REGISTRY["rope_brush"], (), heights)
    places = {(one.fixed["effects.rope_brush.height"], one.fixed["effects.rope_brush.side"]) for one in brushes}
    assert places == {(height, side) for height in heights for side in (1.0, -1.0)}
    assert [[one.name for one in shape.directions] for shape in shapes_of(brushes[0], 9.0)] == [["effects.rope_brush.height"]]
    guide = hypotheses_of_effect(REGISTRY["rope_guide"], (), heights)[-1]
    shapes = {shape.directions[0].name.rpartition(".")[2]: shape for shape in shapes_of(guide, 9.0)}
    assert set(shapes) == {"push", "height"}
    (push,) = shapes["push"].directions
    lower, upper = (guide.fixed["effects.rope_guide.push"] + c * push.changes[push.name] for c in (push.lower, push.upper))
    assert guide.fixed["effects.rope_guide.push"] < 0.0 and lower == pytest.approx(-0.002)  # its sign stays
    assert upper == pytest.approx(-5.0)
