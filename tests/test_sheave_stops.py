"""What holds the sheave in a stop: end stops, a tie-down, and the limit switch that sees it travel."""

import numpy as np
import pytest

from comprope.errors import InputError
from comprope.rope.effects import REGISTRY
from comprope.rope.effects.checks.trial_state import NODES, TrialState
from comprope.rope.model_file import with_changes
from comprope.rope.parameters.parameter_vector import PIT, slot
from comprope.rope.runtime.array_layout import DXX
from comprope.rope.runtime.kernel_arguments import Weights
from comprope.rope.simulator.rope import CompensationRope

from .random_rope import forces, random_state
from .rope_tower import STUB, TOWER, rope

STOPS = {
    "effects.end_stops.stiffness": 2e6, "effects.end_stops.damping": 3e4,
    "effects.end_stops.up": 0.05, "effects.end_stops.down": 0.02,
}  # fmt: skip


def at_height(changes: dict[str, float], height: float, speed: float) -> np.ndarray:
    """Force on the sheave of a rope at random, without it where `changes` are none, at a height [m] and a speed up [m/s]."""
    do = random_state(changes)
    n = do.rope.n
    do.state.q[n], do.state.v[n] = STUB.shaft.pit - height, -speed
    return forces(do)[n]


@pytest.mark.parametrize(
    ("height", "speed", "expected"),
    [
        (0.049, 1.0, 0.0),
        (-0.019, -1.0, 0.0),
        (0.051, 0.5, -(2e6 * 1e-3 + 3e4 * 1.0 / 1.1 * 0.5)),
        (0.051, -0.01, -(2e6 * 1e-3 - 3e4 * 1.0 / 1.1 * 0.01)),
        (0.051, -1.0, 0.0),  # it leaves faster than the stop follows
        (-0.022, -0.5, 2e6 * 2e-3 + 3e4 * 2.0 / 2.1 * 0.5),
    ],
)
def test_a_stop_pushes_by_its_depth_and_never_pulls(height: float, speed: float, expected: float) -> None:
    """Up positive: a stop pushes with k d + c d / (d + 0.1 mm) times the speed into it."""
    found = -(at_height(STOPS, height, speed) - at_height({}, height, speed))
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-5)


@pytest.mark.parametrize(("effect", "moved", "height", "speed"), [
    ("end_stops", "q", 0.051, 0.0), ("end_stops", "q", -0.022, -0.3), ("end_stops", "v", 0.051, 0.3), ("tie_down", "v", 0.0, 0.2),
    ("tie_down", "v", 0.0, 0.31), ("tie_down", "v", 0.0, -0.2),
])  # fmt: skip
def test_tangents_are_those_of_the_forces(effect: str, moved: str, height: float, speed: float) -> None:
    trial = TrialState(REGISTRY[effect], nominal=True)
    for key, value in STOPS.items():
        trial.p[slot(key)] = value
    n, at = NODES, trial.arguments
    at["q"][n], at["v"][n] = trial.p[PIT] - height, -speed

    def move(step: float) -> None:
        at[moved][n] += step

    expected = -trial.slope(move, trial.forces)[n]
    at["weights"] = Weights(1.0, 0.0) if moved == "q" else Weights(0.0, 1.0)
    trial.call("tangents")
    assert expected > 100.0
    assert at["A"][DXX * (n + 1) + n] == pytest.approx(expected, rel=1e-3)


def raised(time: float) -> tuple[float, float, float]:
    """Way up [m], speed and acceleration of the ends: to 2 m/s in 0.3 s, and to rest in 20 ms."""
    t = min(time, 0.32)
    if t <= 0.3:
        return 10.0 / 3.0 * t**2, 20.0 / 3.0 * t, 20.0 / 3.0
    left = 0.32 - t
    return 0.32 - 50.0 * left**2, 100.0 * left, -100.0 if time < 0.32 else 0.0


def thrown(changes: dict[str, float]) -> tuple[CompensationRope, list[dict[str, float]]]:
    """The tower's sheave, whose rope's ends go up and stop at once, for 0.6 s; its outputs every 4 ms."""
    one, dt, seen = rope(changes), 0.004, []
    one.solve_equilibrium(25.0, 25.0)
    for k in range(150):
        path = np.zeros((4, 6))
        path[1], path[3] = [-TOWER.sheave.radius, 0, 0] * 2, [TOWER.sheave.radius, 0, 0] * 2
        for at, time in ((0, k * dt), (3, (k + 1) * dt)):
            way, speed, gain = raised(time)
            path[[0, 2], at : at + 3] = -25.0 - way, -speed, -gain
        one.step(dt, path.ravel())
        seen.append({"time": (k + 1) * dt, **one.all_outputs()})
    return one, seen


def test_end_stops_and_tie_down_hold_a_sheave_that_is_thrown() -> None:
    """Once its rope is slack it flies by v^2 / 2g, and the limit switch sees it pass.

    The rope that unbends from the groove still lifts it by about EI / (2 R^2), 5 % of its weight.
    """
    one, free = thrown({"sheave.limit_switch": 0.2})
    highest = max(now["sheave_displacement"] for now in free)
    flying = next(now for now in free if now["time"] > 0.37)
    flight = flying["sheave_velocity"] ** 2 / 19.62
    assert flight > 0.08
    assert highest == pytest.approx(flying["sheave_displacement"] + flight, abs=0.1 * flight)
    passed = next(now["time"] for now in free if now["sheave_displacement"] >= 0.2)
    assert free[-1]["limit_switch"] == 1.0
    assert free[-1]["limit_switch_time"] == pytest.approx(passed, abs=0.0041)
    assert abs(one.energy_residual) < 10.0  # J, of some 600 J

    stops = {"effects.end_stops.stiffness": 5e6, "effects.end_stops.damping": 2e4, "effects.end_stops.up": 0.4}
    _, stopped = thrown(stops | {"sheave.limit_switch": 0.45})
    assert max(now["sheave_displacement"] for now in stopped) == pytest.approx(0.41, abs=0.01)
    assert (stopped[-1]["limit_switch"], stopped[-1]["limit_switch_time"]) == (0.0, -1.0)

    _, held = thrown({"effects.tie_down.locking_damping": 1e5, "effects.tie_down.locking_speed": 0.1})
    assert max(now["sheave_displacement"] for now in held) < 0.32  # no further than the ends
    assert max(now["peak_element_tension"] for now in held) > 5.0 * max(now["peak_element_tension"] for now in free)


def test_impossible_stops_are_refused() -> None:
    for key, value in (("effects.end_stops.up", -0.1), ("sheave.limit_switch", 0.0), ("effects.tie_down.locking_speed", 11.0)):
        with pytest.raises(InputError, match=f"{key} = {value}"):
            with_changes(TOWER, {key: value})
