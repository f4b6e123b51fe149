"""Sensitivities along a run, against central differences of whole runs."""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import pi

import numpy as np
import pytest

from comprope.drive.trajectory.s_curve import TrajectoryPoint
from comprope.errors import InputError
from comprope.rope.model_file import with_changes
from comprope.rope.parameters.parameter_vector import DECLARED
from comprope.rope.simulator.rope import CompensationRope, values_of
from comprope.rope.simulator.sensitive_rope import SensitiveRope
from comprope_system.identification.data.runs import Channel, Run
from comprope_system.identification.prediction.replay import replay
from comprope_system.identification.prediction.replay_sensitivities import replay_with_sensitivities
from comprope_system.measurements import Trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

from .rope_tower import TOWER, way
from .virtual_elevator import LASER
from .virtual_elevator import MODEL as COARSE

MODEL = with_changes(COARSE, {"rope.element_length": 0.05})

LASERS = {name: Channel(column=name, sensor=name, **LASER) for name in ("cw_low", "car_low")}
CHANNELS = LASERS | {
    "axle": Channel(column="axle", quantity="sheave_displacement", unit="mm"),
    "turning": Channel(column="turning", quantity="sheave_angular_velocity", unit="rad/s"),
    "weight": Channel(column="weight", quantity="sheave_force", unit="N"),
    "pull": Channel(column="pull", quantity="car_end_tension", unit="N"),
}
DIRECTIONS = {
    "bending": {"rope.bending_stiffness": 1.0},
    "damping": {"rope.bending_damping": 1.0},
    "rope mass": {"rope.mass_per_length": 1.0},
    "sheave mass": {"sheave.mass": 1.0},
    "inertia": {"sheave.inertia": 1.0},
    "friction": {"contact.friction_coefficient": 1.0},
    "radius": {"sheave.radius": 1.0},
    "pit": {"shaft.pit": 1.0},
    "offset": {"effects.attachment_offset.car": 1.0, "effects.attachment_offset.counterweight": 0.5},
    "drag": {"effects.air_drag.drag_coefficient": 1.0},
    "runout": {"effects.sheave_eccentricity.eccentricity": 1.0},
    "sway": {"effects.building_sway.amplitude": 1.0},
    "bent": {"effects.intrinsic_curvature.curvature": 1.0},
    "guides": {"effects.guide_friction.coulomb_force": 1.0},
    "slip": {"effects.bending_hysteresis.friction_moment": 1.0},
    "unbalance": {"effects.sheave_unbalance.unbalance": 1.0},
    "seal": {"effects.jammed_seal.stiffness": 1.0},
    "jam": {"effects.jammed_guide.stiffness": 1.0},
    "sticking": {"effects.sticky_guide.breakaway_force": 1.0},
    "brush": {"effects.rope_brush.stiffness": 1.0, "effects.rope_brush.damping": 0.2},
    "rubbing": {"effects.rope_guide.stiffness": 1.0},
    "sloped": {"effects.sloped_guide.slope": 1.0},
    "encoder": {"effects.encoder_scale.excess": 1.0},
}
# Effects that are declared but do nothing yet; effects that act already, one of them with a history.
ABSENT = {
    "effects.bending_hysteresis.yield_curvature": 0.1, "effects.bending_hysteresis.friction_moment": 0.0,
    "effects.building_sway.frequency": 0.3, "effects.building_sway.amplitude": 0.0,
}  # fmt: skip
DRAGGED = {
    "effects.air_drag.drag_coefficient": 1.1, "effects.sheave_eccentricity.eccentricity": 1e-3,
    "effects.bending_hysteresis.yield_curvature": 0.1, "effects.bending_hysteresis.friction_moment": 0.0,
}  # fmt: skip
SLIPPING = {"effects.bending_hysteresis.yield_curvature": 0.1, "effects.bending_hysteresis.friction_moment": 0.5}
MOTIONS, FORCES = ("cw_low", "car_low", "axle", "turning"), ("weight", "pull")
# By what share of a parameter whole runs are differenced: little where the mesh moves along the sheave, so that hardly a node
# comes to touch it that did not; much where the answer is small beside the 1e-8 m to which a time step converges.
SHARE = 1e-5
SHARES = {"radius": 1e-7, "pit": 1e-7, "inertia": 1e-6, "drag": 0.1, "slip": 1e-4, "bent": 1e-4,
          "guides": 1e-3, "sloped": 1e-3, "brush": 0.01, "rubbing": 0.01, "seal": 0.01}  # fmt: skip

# What a tenth of a parameter may change without anybody seeing it: a hundredth of a fine instrument's noise.
UNSEEN = {"cw_low": 1e-6, "car_low": 1e-6, "axle": 1e-7, "turning": 1e-5, "weight": 1e-2, "pull": 1e-2}


@cache
def measured() -> Run:
    """A trip of 3 m as a measurement would have it, without values, of a sheave of 100 kg."""
    time = np.arange(0.0, 4.0, 0.02)
    trip = Trip((jerk_limited(4.0, 3.0, 0.4, np.array([0.7, 0.3, 0.5, 0.4, 0.5, 0.3, 0.5])),), 0.0, "profile")
    return Run("trip", "fit", {"sheave.mass": 100.0}, time, trip.position(time), trip, trip.mirrored(MODEL.shaft.height), {})


@cache
def sensitivities(changes: tuple[tuple[str, float], ...], exact: bool) -> dict[str, dict[str, np.ndarray]]:
    """Derivatives along all directions at the model with changes."""
    return replay_with_sensitivities(with_changes(MODEL, dict(changes)), measured(), CHANNELS, DIRECTIONS, exact=exact)[1]


@cache
def differences(changes: tuple[tuple[str, float], ...], name: str) -> dict[str, np.ndarray]:
    """Derivatives along a direction by differences of whole runs: central, or from one side where a bound is in the way."""
    run, model, direction = measured(), with_changes(MODEL, dict(changes)), DIRECTIONS[name]
    base = values_of(with_changes(model, run.changes))
    values = {key: base.get(key, DECLARED[key].neutral) for key in direction}
    step = SHARES.get(name, SHARE) * size(changes, name)
    bounded = any(values[key] - step * amount < DECLARED[key].minimum for key, amount in direction.items())

    def moved(steps: float) -> dict[str, np.ndarray]:
        there = {key: values[key] + steps * step * amount for key, amount in direction.items()}
        return replay(model, replace(run, changes=run.changes | there), CHANNELS).values

    weights = {0.0: -1.5, 1.0: 2.0, 2.0: -0.5} if bounded else {-1.0: -0.5, 1.0: 0.5}
    runs = {steps: moved(steps) for steps in weights}
    return {column: sum(weight * runs[steps][column] for steps, weight in weights.items()) / step for column in CHANNELS}


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(values**2)))


def errors(changes: dict[str, float], name: str, *, exact: bool) -> dict[str, float]:
    """Errors over signals, both rms, by channel; no signal counts as less than what is UNSEEN."""
    table = tuple(changes.items())
    found, expected, tenth = sensitivities(table, exact)[name], differences(table, name), 0.1 * size(table, name)
    least = {column: UNSEEN[column] / tenth for column in CHANNELS}
    return {column: rms(found[column] - expected[column]) / max(rms(expected[column]), least[column]) for column in CHANNELS}


def size(changes: tuple[tuple[str, float], ...], name: str) -> float:
    """How many times a direction goes into its smallest parameter, or into that one's typical value."""
    base = values_of(with_changes(with_changes(MODEL, dict(changes)), measured().changes))
    values = {key: base.get(key, DECLARED[key].neutral) for key in DIRECTIONS[name]}
    return min(max(abs(values[key]), DECLARED[key].nominal) / abs(amount) for key, amount in DIRECTIONS[name].items())


@pytest.mark.parametrize("name", DIRECTIONS)
def test_derivatives_are_those_of_whole_runs(name: str) -> None:
    """With the tangent factored where each step ends.

    What is left, up to 0.5 %, is the quadrature points of the contact that begin to touch within the difference of runs.
    What a converged step leaves unbalanced, 1e-8 m, shows in forces, and in the turning of a sheave that bending
    and weight hardly turn: steps converged to 1e-11 m leave 0.15 % there. With such steps the pit's depth, which moves nodes
    over the contact's quadrature points, stays below 0.7 % too, and forces below 6 % by bending and 2.4 % by an offset.
    """
    left = errors(ABSENT, name, exact=True)
    assert max(left[column] for column in MOTIONS[:3]) < (0.015 if name == "pit" else 0.007)
    assert left["turning"] < (0.025 if name in ("bending", "sheave mass", "pit") else 0.007)
    assert max(left[column] for column in FORCES) < {"bending": 0.07, "drag": 0.06, "offset": 0.035, "pit": 0.03}.get(name, 0.02)


@pytest.mark.parametrize("name", DIRECTIONS)
def test_derivatives_with_the_factor_that_the_step_has_left(name: str) -> None:
    """That factor is of an iterate before the state reached; at the sheave, where the pit's depth moves nodes, it shows most."""
    left = errors(ABSENT, name, exact=False)
    assert max(left[column] for column in MOTIONS[:3]) < (0.04 if name in ("pit", "radius") else 0.01)
    assert left["turning"] < 0.04


@pytest.mark.parametrize("changes", [DRAGGED, SLIPPING], ids=["drag", "hysteresis"])
@pytest.mark.parametrize("name", ["bending", "sheave mass", "offset", "runout", "drag", "slip"])
def test_derivatives_beside_effects_that_act(changes: dict[str, float], name: str) -> None:
    """Forces of effects are differenced; hysteresis turns round within steps, which leaves 1 %."""
    left = errors(changes, name, exact=True)
    assert max(left[column] for column in MOTIONS[:3]) < 0.02


@pytest.mark.parametrize(("changes", "exact"), [({}, False), (SLIPPING, True)], ids=["plain", "hysteresis"])
def test_wires_that_stick_and_slip_have_exact_derivatives_unasked(changes: dict[str, float], exact: bool) -> None:
    """With the factor that the step has left they may grow without end beside them."""
    model, directions = with_changes(MODEL, changes), {"bending": DIRECTIONS["bending"]}
    found = {
        asked: replay_with_sensitivities(model, measured(), CHANNELS, directions, exact=asked)[1]["bending"]["axle"]
        for asked in (None, True, False)
    }
    assert np.array_equal(found[None], found[exact])
    assert not np.array_equal(found[None], found[not exact])


def path(car: float, after: float) -> np.ndarray:
    """The ends' path while the car goes from one height to another in 10 ms."""
    ends = np.zeros((4, 6))
    ends[0, [0, 3]], ends[2, [0, 3]] = (-car, -after), (car - MODEL.shaft.height, after - MODEL.shaft.height)
    ends[1, [0, 3]], ends[3, [0, 3]] = -MODEL.sheave.radius, MODEL.sheave.radius
    ends[[0, 2], 1] = ends[[0, 2], 4] = (car - after) / 0.01, (after - car) / 0.01
    return ends.ravel()


def ridden(rope: SensitiveRope | CompensationRope, steps: range) -> None:
    """Carry a rope on at 0.5 m/s."""
    for k in steps:
        rope.step(0.01, path(5.0 + 0.005 * k, 5.0 + 0.005 * (k + 1)))


def test_the_rope_itself_moves_to_the_same_bits_and_a_saved_state_goes_on() -> None:
    plain, beside = CompensationRope(MODEL), SensitiveRope(MODEL, {"mass": {"sheave.mass": 1.0}}, exact=True)
    for rope in (plain, beside):
        rope.solve_equilibrium(5.0, MODEL.shaft.height - 5.0)
        ridden(rope, range(20))
    assert plain.state.to_bytes() == beside.rope.state.to_bytes()
    saved = beside.to_bytes()
    ridden(beside, range(20, 30))
    expected = beside.to_bytes()
    beside.from_bytes(saved)
    ridden(beside, range(20, 30))
    assert beside.to_bytes() == expected


@pytest.mark.parametrize("speed", [2.5, 6.0, 9.0, 15.0])
def test_a_rope_takes_the_same_steps_with_and_without_derivatives_at_any_speed(speed: float) -> None:
    """Above 6 m/s (elements of 5 cm, steps of 5 ms) time steps are shortened."""
    tower, acceleration, dt = with_changes(TOWER, {"solver.step": 0.005}), 6.0, 0.02
    plain, beside = CompensationRope(tower), SensitiveRope(tower, {"mass": {"sheave.mass": 1.0}})
    times = np.arange(0.0, speed / acceleration + 2.0 * dt, dt)
    car = [TrajectoryPoint(2.0 + 0.5 * acceleration * t * t, acceleration * t, acceleration) for t in times]
    for rope in (plain, beside):
        rope.solve_equilibrium(2.0, tower.shaft.height - 2.0)
        for before, after in pairwise(car):
            rope.step(dt, way(tower.sheave.radius, tower.shaft.height, before, after))
    assert plain.count == beside.rope.count
    assert plain.state.to_bytes() == beside.rope.state.to_bytes()


def test_a_direction_may_begin_with_other_values_of_what_does_nothing_yet() -> None:
    """The runout's phase does nothing without a runout: half a turn of it changes the sign of the answer."""
    runout = {"effects.sheave_eccentricity.eccentricity": 1.0}
    rope = SensitiveRope(MODEL, {"down": runout, "up": runout}, {"up": {"effects.sheave_eccentricity.phase": pi}})
    rope.solve_equilibrium(5.0, MODEL.shaft.height - 5.0)
    ridden(rope, range(30))
    down, up = rope.lateral_displacement().T
    assert up == pytest.approx(-down, rel=1e-4)  # by differences of 1e-7 m, whose contact forces are not quite linear
    assert np.abs(down).max() > 1e-3


def test_a_direction_that_changes_nothing_has_no_derivative() -> None:
    rope = SensitiveRope(MODEL, {"top": {"rope.diameter": 1.0}})
    rope.solve_equilibrium(5.0, MODEL.shaft.height - 5.0)
    ridden(rope, range(10))
    assert np.abs(rope.lateral_displacement()).max() < 1e-9  # roundings of shapes at rest, 1e-12 m, over 1e-3 of the diameter
    assert np.abs(rope.forces()["sheave_force"]).max() < 1e-4


def test_no_directions_at_all() -> None:
    replayed, derivatives = replay_with_sensitivities(MODEL, measured(), LASERS, {})
    plain = replay(MODEL, measured(), LASERS)
    assert derivatives == {}
    assert all(np.array_equal(replayed.values[column], plain.values[column], equal_nan=True) for column in LASERS)


@pytest.mark.parametrize("key", ["solver.step", "rope.element_length", "sheave.colour", "derived.element"])
def test_what_is_no_physical_parameter_is_refused(key: str) -> None:
    with pytest.raises(InputError, match=rf"^{key}: no sensitivity; a physical parameter such as .* is accepted$"):
        SensitiveRope(MODEL, {"wrong": {key: 1.0}})
