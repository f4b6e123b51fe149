"""A rope that is pushed: its law, its balance, and a sheave that is dropped and caught by it."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.rope.effects import REGISTRY
from comprope.rope.effects.checks.trial_state import NODES, TrialState
from comprope.rope.mechanics import axial_law, internal_tangent
from comprope.rope.parameters.parameter_vector import EA, ELEMENT, RATIO
from comprope.rope.runtime.array_layout import INVERSE, SXX, SXY, SYY, TX, TY
from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.sensitive_rope import SensitiveRope

from .rope_tower import TOWER, ride, rope

LAW = {name: getattr(one, "py_func", one) for name, one in vars(axial_law).items() if callable(one)}
segment_blocks = getattr(internal_tangent.segment_blocks, "py_func", internal_tangent.segment_blocks)
P = TrialState(REGISTRY["air_drag"], nominal=False).p  # parameters of a rope: EA = 8e6 N
MOST = 80.0  # N, EA times the strain over which stiffness is lost


def law(x: float, ratio: float = 1e-3) -> tuple[float, float]:
    P[RATIO] = ratio
    force, slope = LAW["axial_force"](P, x)
    return force, slope


@pytest.mark.parametrize("x", [-1e4, -100.0, -MOST - 1e-3, -MOST + 1e-3, -50.0, -10.0, -1e-3])
def test_the_law_s_slope_and_energy_belong_to_its_force(x: float) -> None:
    h = 1e-4 * max(1.0, abs(x) * 0.01)
    force, slope = law(x)
    assert slope == pytest.approx((law(x + h)[0] - law(x - h)[0]) / (2.0 * h), rel=1e-5, abs=1e-8)
    energy = [LAW["elastic_energy"](P, x + side) for side in (h, -h)]
    assert force / P[EA] == pytest.approx((energy[0] - energy[1]) / (2.0 * h), rel=1e-6)
    by_ratio = (law(x, 2e-3)[0] - law(x, 1e-3)[0]) / 1e-3
    assert LAW["force_by_ratio"](P, x) == pytest.approx(by_ratio, rel=1e-6)


def test_the_law_leaves_tension_alone_and_takes_compression_away() -> None:
    assert law(123.4) == (123.4, 1.0)
    assert law(-1e5)[0] == pytest.approx(-1e-3 * 1e5 - 0.5 * MOST * (1.0 - 1e-3))
    assert law(-1e5, 1.0) == (-1e5, 1.0)
    slopes = [law(x)[1] for x in np.linspace(-200.0, 1.0, 500)]
    assert all(later >= before for before, later in pairwise(slopes))


def test_the_tangent_along_a_segment_is_the_law_s_slope() -> None:
    trial = TrialState(REGISTRY["air_drag"], nominal=False)
    n, w, at = NODES, trial.arguments["w"], trial.arguments
    trial.p[RATIO], at["v"][:] = 1e-3, 0.0
    trial.refresh()
    segment_blocks(n, trial.p, w, 1.0, 0.0)
    tx, ty, xx, xy, yy, inverse = (w[k * (n + 1) : k * (n + 1) + n - 1] for k in (TX, TY, SXX, SXY, SYY, INVERSE))
    along = xx * tx * tx + 2.0 * xy * tx * ty + yy * ty * ty
    l = trial.p[ELEMENT]
    slopes = [law(trial.p[EA] * (1.0 / one / l - 1.0))[1] for one in inverse]
    assert 10 < slopes.count(1.0) < n - 10
    assert along == pytest.approx(trial.p[EA] / l * np.array(slopes), rel=1e-6)


def test_a_trip_without_slack_is_that_of_a_rod_to_the_bit() -> None:
    found = []
    for ratio in (1.0, 1e-3):
        moving, trip = rope({"rope.compression_ratio": ratio}), plan_s_curve(Profile(), 20.0, 26.0, 0.0)
        moving.solve_equilibrium(20.0, 30.0)
        for _ in range(100):
            ride(moving, trip, 0.02)
        found.append(b"".join(one.tobytes() for one in moving.state))
    assert found[0] == found[1]


DROP, LOWERING, MIDDLE = 0.01, 0.02, 25.0  # m, s, m: by how much and how fast both ends go down, and where they are


def lowered(time: float) -> tuple[float, float, float]:
    """Way down [m], speed and acceleration of the ends: from rest to rest, faster than the sheave falls."""
    s = min(time / LOWERING, 1.0)
    way = DROP * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    rate = 30.0 * DROP * s**2 * (1.0 - s) ** 2 / LOWERING
    return way, rate, 60.0 * DROP * s * (1.0 - s) * (1.0 - 2.0 * s) / LOWERING**2


def lower(one: CompensationRope | SensitiveRope, steps: int) -> Iterator[None]:
    """Bring a rope to rest and let its ends go down, in steps of 4 ms."""
    one.solve_equilibrium(MIDDLE, MIDDLE)
    dt, radius = 0.004, TOWER.sheave.radius
    for k in range(steps):
        path = np.zeros((4, 6))
        path[1], path[3] = [-radius, 0, 0] * 2, [radius, 0, 0] * 2
        for at, time in ((0, k * dt), (3, (k + 1) * dt)):
            way, rate, gain = lowered(time)
            path[[0, 2], at : at + 3] = way - MIDDLE, rate, gain
        one.step(dt, path.ravel())
        yield


def caught(changes: dict[str, float]) -> tuple[CompensationRope, list[dict[str, float]]]:
    """The sheave of the tower when its rope's ends go down, and its outputs every 4 ms for 0.16 s."""
    one = rope(changes)
    return one, [one.all_outputs() for _ in lower(one, 40)]


def caught_on_a_spring() -> float:
    """The largest force [N] on a mass that hangs on a spring without mass or loss which only pulls, both sides of the rope."""
    mass, spring = TOWER.sheave.mass, 4.0 * TOWER.rope.axial_stiffness / TOWER.rope_length
    rest = mass * 9.81 / spring

    def force(time: float, fallen: float) -> float:
        return spring * max(fallen + rest - lowered(time)[0], 0.0)

    found = solve_ivp(
        lambda t, y: (y[1], 9.81 - force(t, y[0]) / mass), (0.0, 0.16), (0.0, 0.0), max_step=1e-4, rtol=1e-8, atol=1e-10
    )
    return max(force(t, y) for t, y in zip(found.t, found.y[0], strict=True))


def test_a_dropped_sheave_is_caught_as_by_a_spring_that_only_pulls() -> None:
    """A light rope that hardly bends, so that neither its mass nor its stiffness on the sheave takes part.

    3 % of force remain: the rule of slack steps is of first order, and the rope that is caught has swung out sideways.
    """
    light = {"rope.mass_per_length": 0.05, "rope.bending_stiffness": 0.1, "rope.bending_damping": 1e-3, "contact.stiffness": 1e9}
    one, seen = caught(light | {"rope.axial_damping": 200.0, "solver.step": 0.001})
    expected = caught_on_a_spring()
    assert expected > 3.0 * TOWER.sheave.mass * 9.81
    assert max(now["slack_length"] for now in seen) > 30.0  # m
    assert max(now["sheave_force"] for now in seen) == pytest.approx(expected, rel=0.05)
    # The ends push with the stiffness that is left, and its 40 N.
    assert min(now["car_end_tension"] for now in seen) > -60.0
    # Of the 12 J that the sheave falls by.
    assert abs(one.energy_residual) < 0.6


def test_what_the_run_has_seen_of_slack_stays_and_restarts_to_the_bit() -> None:
    one, seen = caught({})
    slack = [now["slack_length"] for now in seen]
    gone = max(k for k, length in enumerate(slack) if length > 0.0)
    assert gone < len(seen) - 5
    assert seen[-1]["slack_duration"] == seen[gone + 1]["slack_duration"] > 0.01
    # The peak is that of each step's last iterate, a correction of less than 10 nm from what it reaches.
    assert seen[-1]["peak_element_tension"] >= max(now["largest_element_tension"] for now in seen) - 1.0
    assert min(now["least_element_tension"] for now in seen) < -40.0
    kept = one.state.to_bytes()
    again = rope({})
    again.state.from_bytes(kept)
    for other in (one, again):
        other.step(0.02, np.array(other.workspace.ends.path) if other is one else np.array(one.workspace.ends.path))
    assert again.state.to_bytes() == one.state.to_bytes()


def test_derivatives_go_through_slack_and_catching() -> None:
    """Of the sheave's height 0.12 s after the start, when the rope that was slack has caught it, against differences."""
    sizes = {"sheave.mass": 1.0, "rope.axial_stiffness": 1e5, "rope.compression_ratio": 1e-3, "rope.bending_stiffness": 1.0}
    sensitive = SensitiveRope(TOWER, {key: {key: size} for key, size in sizes.items()}, exact=True)
    slack = [sensitive.rope.all_outputs()["slack_length"] for _ in lower(sensitive, 30)]
    assert max(slack) > 30.0 and slack[-1] == 0.0
    for derivative, (key, size) in zip(sensitive.of_sheave("sheave_displacement"), sizes.items(), strict=True):
        component, _, name = key.partition(".")
        beside = []
        for step in (1e-4 * size, -1e-4 * size):
            one = rope({key: getattr(getattr(TOWER, component), name) + step})
            for _ in lower(one, 30):
                pass
            beside.append(one.sheave()["sheave_displacement"])
        # The ratio changes the height by 3 um, of which the steps' tolerance of 10 nm leaves some per cent.
        close = 0.03 if name == "compression_ratio" else 2e-3
        assert derivative == pytest.approx((beside[0] - beside[1]) / 2e-4, rel=close), key
