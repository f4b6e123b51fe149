"""The pieces of the model, each alone: tangents, linear solver, paths, sensors, and every effect.

Tangents are compared with central differences of the forces; the rope then rubs on a turning sheave,
bent and moving at random.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.kernels.jit import kernel
from comprope.quantities import quantities
from comprope.rope.compiler.entry_points import compiled
from comprope.rope.compiler.workspace import RopeWorkspace
from comprope.rope.effects import REGISTRY
from comprope.rope.effects.checks.trial_state import TrialState
from comprope.rope.linalg import block_band, bordered_band
from comprope.rope.mechanics import end_conditions, equations_of_motion, internal_tangent, sensors
from comprope.rope.mechanics.contact.contact_law import contact_radius, friction_law, normal_law
from comprope.rope.mechanics.energy import LOSSES, SPENT
from comprope.rope.mechanics.internal_forces import angle
from comprope.rope.parameters.parameter_vector import DECLARED, slot
from comprope.rope.runtime.array_layout import BAND, COLUMNS, CONTACT, FIRST, FRICTION_LOSS, LAST, ROWS, TENSION
from comprope.rope.runtime.kernel_arguments import Motion, Weights, Workspace
from comprope.rope.simulator.end_motion import EndMotion, parabola

from .random_rope import COMPANIONS, TIME, forces, nominal, random_state
from .rope_tower import STUB, TOWER, ride, rope

# Effects that can only take energy, whatever the rope does. Wire friction does so over a cycle, not at each moment.
DISSIPATIVE = ("air_drag", "bearing_friction", "guide_friction", "sheave_damper", "sticky_guide", "tie_down")
UNDAMPED = {"rope.axial_damping": 0.0, "rope.bending_damping": 0.0}


def differences(do: RopeWorkspace, variable: np.ndarray, h: float) -> np.ndarray:
    """Central differences of all forces by all entries of q or v."""
    columns = []
    for k, value in enumerate(variable.tolist()):
        sides = []
        for side in (h, -h):
            variable[k] = value + side
            sides.append(forces(do))
        variable[k] = value
        columns.append((sides[0] - sides[1]) / (2.0 * h))
    return np.array(columns).T


@cache
def kernel_of_band(effects: tuple[str, ...]) -> Callable[..., None]:
    """The kernel `tangent_band` with these effects, for Python: other kernels inline it."""
    arguments = "n, time, p, motion, work, mass, weights"
    return kernel(eval(f"lambda {arguments}: tangent_band({arguments})", compiled(effects)["forces"].function.__globals__))


def band_of(do: RopeWorkspace, ck: float, cc: float, mass: float = 0.0) -> np.ndarray:
    """The band A at the state of the last call of `forces`, effects included."""
    work, s = do.work._replace(A=np.zeros_like(do.work.A)), do.state
    kernel_of_band(do.effects)(do.rope.n, TIME, do.rope.p, Motion(s.q, s.v, s.a), work, mass, Weights(ck, cc))
    return work.A


def dense(n: int, a: np.ndarray, z: np.ndarray) -> np.ndarray:
    """The matrix that band A and contact tangent Z stand for, sheave included."""
    m = n + 1
    full, rows, corner = np.zeros((2 * m, 2 * m)), a.reshape(BAND, m), z[CONTACT * m :]
    contact = z[: CONTACT * m].reshape(CONTACT, m)
    for i in range(m):
        full[np.ix_((i, m + i), (i, m + i))] += np.array([[rows[0, i], rows[1, i]], [rows[1, i], rows[2, i]]])
    for distance, first in ((1, 3), (2, 7)):
        for i in range(n - distance):
            block, j = rows[first : first + 4, i].reshape(2, 2), i + distance
            full[np.ix_((i, m + i), (j, m + j))] += block
            full[np.ix_((j, m + j), (i, m + i))] += block.T
    for i in range(n):
        for j in range(max(i - 2, 0), min(i + 3, n)):
            first = 4 * (j - i + 2)
            full[np.ix_((i, m + i), (j, m + j))] += contact[first : first + 4, i].reshape(2, 2)
        full[np.ix_((i, m + i), (n, m + n))] += contact[COLUMNS : COLUMNS + 4, i].reshape(2, 2)
        full[np.ix_((n, m + n), (i, m + i))] += contact[ROWS : ROWS + 4, i].reshape(2, 2)
    full[np.ix_((n, m + n), (n, m + n))] += corner.reshape(2, 2)
    return full


def tangent(do: RopeWorkspace, ck: float, cc: float) -> np.ndarray:
    """ck df/dq + cc df/dv as the kernels give it."""
    do.work.Z[:] = 0.0
    forces(do, ck, cc, True)
    return -dense(do.rope.n, band_of(do, ck, cc), do.work.Z)


def free(n: int) -> np.ndarray:
    """Indices of what moves freely: all but the four coordinates of the prescribed ends."""
    return np.setdiff1d(np.arange(2 * (n + 1)), (0, n - 1, n + 1, 2 * n))


def agrees(found: np.ndarray, expected: np.ndarray, floor: float) -> bool:
    """Equal to a millionth of each entry, or to the floor that rounding of the differences sets."""
    return bool(np.all(abs(found - expected) <= 1e-6 * abs(expected) + floor))


# -- tangents ------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
def test_tangent_by_position(seed: int) -> None:
    do = random_state(UNDAMPED, seed)
    inner = np.ix_(free(do.rope.n), free(do.rope.n))
    # Differences over 10 nm: forces of 1e5 N carry 1e-11 N of rounding, 2e-3 N/m of the difference; the law of
    # contact damping, whose third derivative is 1e14 N/m3, leaves 1e-2. Entries reach 3e8.
    assert agrees(tangent(do, 1.0, 0.0)[inner], differences(do, do.state.q, 1e-8)[inner], 0.1)


@pytest.mark.parametrize("seed", range(3))
def test_tangent_by_velocity(seed: int) -> None:
    do = random_state({}, seed)
    inner = np.ix_(free(do.rope.n), free(do.rope.n))
    # Rounding of 1e-11 N over 20 um/s. Entries reach 8e4.
    assert agrees(tangent(do, 0.0, 1.0)[inner], differences(do, do.state.v, 1e-5)[inner], 1e-5)


def test_random_states_touch_slip_and_lift_off() -> None:
    """Else the tangents above would be those of a rope that sticks, or hangs free."""
    do = random_state({})
    forces(do)
    m, q, p = do.rope.n + 1, do.state.q, do.rope.p
    wrap = np.arange(int(do.work.contact[FIRST]), int(do.work.contact[LAST]) + 1)
    middle = lambda at: q[at + wrap] + (q[at + wrap - 1] - 2.0 * q[at + wrap] + q[at + wrap + 1]) / 8.0  # noqa: E731
    depth = contact_radius(p) - np.hypot(middle(0) - q[m - 1], middle(m))
    assert 5 < np.count_nonzero(depth > 0.0) < wrap.size - 5
    assert do.work.contact[FRICTION_LOSS] > 1.0


def test_tangent_leaves_out_how_damping_turns_with_the_rope() -> None:
    """The damping forces' derivative by position is left out; it is small beside the stiffness, so Newton hardly slows."""
    do = random_state({})
    inner = np.ix_(free(do.rope.n), free(do.rope.n))
    missing = tangent(do, 1.0, 0.0)[inner] - differences(do, do.state.q, 1e-8)[inner]
    # c_A times the spin of 0.2 m/s over an element, 4 rad/s, against EA: 2e3 * 4 / 8e6.
    assert 1e-4 < abs(missing).max() / 3.2e8 < 3e-3


# -- linear solver -------------------------------------------------------------------------------


@pytest.mark.parametrize(("n", "first", "last"), [(30, 8, 20), (30, 3, 12), (41, 19, 36), (17, 2, 14)])
def test_elimination_from_both_ends_equals_a_dense_solve(n: int, first: int, last: int) -> None:
    """A random symmetric band with an unsymmetric bordered zone, solved with and without a fresh factor."""
    m, random = n + 1, np.random.default_rng(n)
    a, z = random.normal(size=(BAND, m)), np.zeros((CONTACT, m))
    a[[0, 2]] += 12.0  # safely positive definite, as elimination without pivots wants it
    internal_tangent.fix_end_rows(n, a.reshape(-1))
    z[:, first : last + 1] = random.normal(size=(CONTACT, last - first + 1))
    for i, side in ((first, -2), (first, -1), (first + 1, -2), (last, 2), (last, 1), (last - 1, 2)):
        z[4 * (side + 2) : 4 * (side + 3), i] = 0.0  # what touches the groove lies within the zone
    contact = np.append(z.ravel(), random.normal(size=4))
    matrix, right = dense(n, a.reshape(-1), contact), random.normal(size=(2, 2 * m))
    factored, work, size = a.reshape(-1).copy(), np.zeros(block_band.FACTOR * m), 2 * (last - first + 1)
    bordered, found = np.zeros((bordered_band.ROW + 2) * 2 * m + 4), right.copy()
    block_band.factor(n, factored, work, found[0], first, last)
    bordered_band.assemble_bordered(n, factored, contact, bordered, first, last)
    bordered_band.factor_bordered(size, bordered)
    block_band.forward_substitute(n, work, found[1], first, last)
    for one in found:
        bordered_band.solve_bordered(n, bordered, one, first, last)
        block_band.back_substitute(n, work, one, first, last)
    # Rounding grows by the condition of the matrix, below 1e4 here.
    assert found == pytest.approx(np.linalg.solve(matrix, right.T).T, rel=1e-10, abs=1e-11)


# -- small laws ----------------------------------------------------------------------------------


def test_angle_of_a_sine() -> None:
    bend = np.linspace(-0.2, 0.2, 41)  # rad between neighbouring elements: l / R is at most 0.5, 0.125 in the tower
    found = np.array([angle(np.sin(one)) for one in bend.tolist()])
    assert found == pytest.approx(bend, rel=3e-9, abs=0.0)  # the first term left out, 945/42240 s^10: 2e-9 of 0.2 rad


def test_contact_pushes_but_never_pulls() -> None:
    p = rope(model=STUB).p
    stiffness, damping = TOWER.contact.stiffness, TOWER.contact.damping
    assert normal_law(p, -1e-6, -1.0) == (0.0, 0.0, 0.0)
    assert normal_law(p, 1e-4, -10.0) == (0.0, 0.0, 0.0)  # leaves faster than it is pushed: no suction
    assert normal_law(p, 1e-3, 0.0)[0] == pytest.approx(stiffness * 1e-3, rel=1e-15)
    # The damping has faded in by one part in eleven at ten times the fading depth of 0.1 mm.
    assert normal_law(p, 1e-3, 0.2)[0] == pytest.approx(stiffness * 1e-3 + damping * 0.2 / 1.1, rel=1e-14)


def test_friction_opposes_slip_and_is_bounded() -> None:
    p, contact = rope(model=STUB).p, TOWER.contact
    assert friction_law(p, 0.0)[0] == 0.0
    assert friction_law(p, contact.slip_velocity)[0] == pytest.approx(contact.friction_coefficient / np.sqrt(2.0), rel=1e-14)
    assert friction_law(p, -100.0)[0] == pytest.approx(-contact.friction_coefficient, rel=1e-7)  # (v_0 / v)^2 / 2 below it


# -- paths of the ends ---------------------------------------------------------------------------


def test_ends_follow_a_motion_of_fifth_order_exactly() -> None:
    way, dt = np.polynomial.Polynomial([2.0, -1.0, 0.7, 3.0, -2.0, 0.9]), 0.7
    path = np.array([way.deriv(k)(at) if k else way(at) for at in (0.0, dt) for k in range(3)])
    for s in np.linspace(0.0, 1.0, 11).tolist():
        expected = [way(s * dt), way.deriv(1)(s * dt), way.deriv(2)(s * dt)]
        assert end_conditions.follow(path, 0, dt, s) == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_parabola_through_uneven_samples() -> None:
    x = np.polynomial.Polynomial([1.0, -2.0, 3.0])
    times = np.array([0.0, 0.003, 0.02])
    found = parabola(times, x(times), 0.025)
    # Divided differences lose eps / (3 ms)^2 of the curvature.
    assert found == pytest.approx((x(0.025), x.deriv()(0.025), 6.0), rel=1e-9)


@pytest.mark.parametrize("derivatives", [False, True])
@pytest.mark.parametrize("at_end", [False, True])
def test_paths_join_smoothly_and_reach_a_steady_motion(derivatives: bool, at_end: bool) -> None:
    """From step to step position, velocity and acceleration go on; uniform acceleration is then met exactly."""

    def inputs(time: float) -> dict[str, float]:
        x, v, a = 3.0 + 0.4 * time**2, 0.8 * time, 0.8
        car = {"car_position": x, "car_velocity": v, "car_acceleration": a, "car_lateral_displacement": 0.01}
        return car | {
            "counterweight_position": -x,
            "counterweight_velocity": -v,
            "counterweight_acceleration": -a,
            "counterweight_lateral_displacement": 0.02,
        }

    motion, time, before = EndMotion(0.4, inputs(0.0), 0.0, derivatives=derivatives, at_end=at_end), 0.0, None
    for dt in (0.01, 0.02, 0.005, 0.01, 0.03):
        path, duration = motion.path(time, dt, inputs(time + dt if at_end else time))
        assert duration == dt
        path = path.reshape(4, 6)
        if before is not None:
            assert np.array_equal(path[:, :3], before[:, 3:])
        time, before = time + dt, path
    x, v, a = 3.0 + 0.4 * time**2, 0.8 * time, 0.8
    # Three samples within 50 ms: eps / (5 ms)^2 of the curvature, times 3 m.
    expected = [[-x, -v, -a], [-0.41, 0.0, 0.0], [x, v, a], [0.42, 0.0, 0.0]]
    assert path[:, 3:] == pytest.approx(np.array(expected), abs=1e-9)


# -- sensors -------------------------------------------------------------------------------------


def seen(q: np.ndarray, n: int, side: int, x: float) -> tuple[float, bool]:
    answer = np.zeros(2)
    sensors.read_sensor(n, q, side, x, answer)
    return float(answer[0]), bool(answer[1])


def curve(n: int, shape: np.polynomial.Polynomial) -> np.ndarray:
    """A V of nodes at even depths on both sides, whose lateral positions are a polynomial of the depth."""
    half = np.linspace(-1.0, 1.0, n)
    return np.concatenate([10.0 - 10.0 * abs(half), [0.0], np.sign(half) * shape(10.0 * (1.0 - abs(half))), [0.0]])


@pytest.mark.parametrize("side", [-1, 1])
def test_sensor_reads_a_quadratic_exactly_and_a_cubic_closely(side: int) -> None:
    n = 41  # nodes 0.5 m apart in depth
    parabolic, cubic = np.polynomial.Polynomial([0.5, 0.2, -0.03]), np.polynomial.Polynomial([0.5, 0.2, -0.03, 0.004])
    for x in (0.77, 3.1, 6.25, 7.9):
        # A bisection of 40 halvings leaves 1e-12 of an element.
        assert seen(curve(n, parabolic), n, side, x) == (pytest.approx(side * parabolic(x), abs=1e-12), True)
        # Slopes by central differences are wrong by l^2 f'''/6 for a cubic: at most l^3 f''' / 6 * 0.096 in between.
        assert seen(curve(n, cubic), n, side, x)[0] == pytest.approx(side * cubic(x), abs=0.5**3 * 0.004 * 0.1)


def test_sensor_finds_a_node_where_it_is() -> None:
    n = 41
    q = curve(n, np.polynomial.Polynomial([0.5, 0.2, -0.03, 0.004]))
    for i in (4, 9, 15):
        assert seen(q, n, -1, q[i]) == (pytest.approx(q[n + 1 + i], abs=1e-11), True)


def test_sensor_whose_rope_is_gone_says_so() -> None:
    hung = rope()
    hung.solve_equilibrium(10.0, 40.0)
    assert hung.lateral_displacement("car", 10.5) == (pytest.approx(0.0, abs=1e-12), False)  # above the car's end
    assert not hung.lateral_displacement("counterweight", -2.5)[1]  # below the sheave
    assert hung.lateral_displacement("car", 9.5)[1]
    assert hung.lateral_displacement("counterweight", 10.5)[1]


def test_maximum_is_the_largest_of_all_readings() -> None:
    hung = rope({"sheave.mass": 12.0})
    hung.solve_equilibrium(0.0, 50.0)
    most, height = hung.maximum("counterweight")
    readings = [hung.lateral_displacement("counterweight", h)[0] for h in np.linspace(-1.0, 20.0, 421).tolist()]
    assert most == pytest.approx(max(readings), abs=2e-5)  # between nodes the rope bulges by l^2 kappa / 8: 20 um
    assert hung.lateral_displacement("counterweight", height)[0] == pytest.approx(most, abs=1e-9)


# -- every effect --------------------------------------------------------------------------------


EVERY_EFFECT = tuple(REGISTRY)


@pytest.mark.parametrize("effect", EVERY_EFFECT)
def test_effect_at_its_neutral_value_changes_nothing(effect: str) -> None:
    """Bit for bit what the kernels give that have no effects joined to them."""
    names = [f"effects.{effect}.{one.name}" for one in quantities(REGISTRY[effect])]
    do = random_state({name: DECLARED[name].neutral for name in names})
    state, work, n, p = do.state.copy(), Workspace(*(array.copy() for array in do.work)), do.rope.n, do.rope.p
    motion, weights = Motion(state.q, state.v, state.a), Weights(0.9, 0.1)
    with_effect = forces(do, 0.9, 0.1, True)
    equations_of_motion.forces(n, TIME, p, motion, state.history, work, weights, True)
    assert np.array_equal(with_effect, work.f)
    assert np.array_equal(do.work.Z, work.Z)
    work.A[:] = 0.0
    equations_of_motion.tangent_band(n, TIME, p, motion, work, 1.0, weights)
    assert np.array_equal(band_of(do, 0.9, 0.1, mass=1.0), work.A)
    do.ends.path[:] = np.random.default_rng(1).normal(size=do.ends.path.size)
    do.place_ends(t=TIME, dt=0.1, s=0.4)
    end_conditions.place_ends(n, TIME, p, do.ends.path, 0.1, 0.4, motion)
    assert all(np.array_equal(getattr(do.state, name), getattr(motion, name)) for name in "qva")


@pytest.mark.parametrize("effect", EVERY_EFFECT)
def test_effect_keeps_the_tangent_right(effect: str) -> None:
    do = random_state(nominal(effect) | UNDAMPED)
    inner = np.ix_(free(do.rope.n), free(do.rope.n))
    # Left out on purpose: how air drag turns with the rope (1e-3 N/m) and how the arm of the contact force of an
    # eccentric groove turns with it (e P = 1 N m on the sheave's angle). Stiffnesses reach 3e8.
    assert agrees(tangent(do, 1.0, 0.0)[inner], differences(do, do.state.q, 1e-8)[inner], 2.0)
    floor = {"sheave_unbalance": 0.1}.get(effect, 1e-5)  # how its force changes with omega, 2 U omega = 0.1 N s
    assert agrees(tangent(do, 0.0, 1.0)[inner], differences(do, do.state.v, 1e-5)[inner], floor)


@pytest.mark.parametrize("effect", [name for name in EVERY_EFFECT if {"forces", "moments"} & set(REGISTRY[name].hooks)])
def test_effect_states_the_power_of_its_own_forces(effect: str) -> None:
    k = list(REGISTRY).index(effect)
    for seed in range(3):
        acting, absent = random_state(nominal(effect), seed), random_state(COMPANIONS.get(effect, {}), seed)
        absent.state.from_bytes(acting.state.to_bytes())
        work = (forces(acting) - forces(absent)) @ acting.state.v
        # Forces of 1e5 N at 0.2 m/s, over 140 coordinates, leave 1e-9 W of rounding.
        assert acting.work.power[k] == pytest.approx(work, rel=1e-9, abs=1e-7)


def test_drag_in_a_wind_states_its_power_on_the_rope_and_not_that_by_the_air() -> None:
    """Force times the velocity of the rope itself, not of the rope through the air that blows outward."""
    k = list(REGISTRY).index("air_drag")
    for seed in range(3):
        acting, absent = random_state(nominal("shaft_airflow"), seed), random_state({}, seed)
        acting.state.v[0] = -2.0  # the car rises, which makes a wind of 0.6 m/s
        absent.state.from_bytes(acting.state.to_bytes())
        work = (forces(acting) - forces(absent)) @ acting.state.v
        # Forces of 1e5 N at up to 2 m/s leave 1e-9 W of rounding.
        assert abs(work) > 1e-4  # W
        assert acting.work.power[k] == pytest.approx(work, rel=1e-9, abs=1e-7)


@pytest.mark.parametrize("effect", [name for name in EVERY_EFFECT if "ends" in REGISTRY[name].hooks])
def test_effect_moves_the_ends_with_consistent_velocity_and_acceleration(effect: str) -> None:
    """Central differences along a path on which the ends rise and move aside."""
    do, dt, h = random_state(nominal(effect)), 0.1, 1e-4
    do.ends.path[:] = np.random.default_rng(2).normal(size=do.ends.path.size)
    n = do.rope.n

    def placed(s: float) -> np.ndarray:
        do.place_ends(t=TIME + s * dt, dt=dt, s=s)
        return np.array([array[[0, n - 1, n + 1, 2 * n]] for array in (do.state.q, do.state.v, do.state.a)])

    slope = (placed(0.4 + h) - placed(0.4 - h)) / (2.0 * h * dt)
    # Motions of some metres within 0.1 s: rounding of 1e-15 over 20 us, and h^2 of third derivatives of 1e5.
    assert slope[:2] == pytest.approx(placed(0.4)[1:], rel=1e-5, abs=1e-4)


@pytest.mark.parametrize("effect", DISSIPATIVE)
def test_dissipative_effect_never_puts_energy_in(effect: str) -> None:
    k = list(REGISTRY).index(effect)
    for seed in range(10):
        do = random_state(nominal(effect), seed)
        forces(do)
        assert do.work.power[k] < 0.0


@cache
def short_run(effect: str) -> tuple[dict[str, float], float, np.ndarray, dict[str, float]]:
    """Energies, residual, state and outputs after two seconds of acceleration with an effect, 20 m up the tower."""
    moving = rope(nominal(effect))
    moving.solve_equilibrium(20.0, 30.0)
    trip = plan_s_curve(Profile(), 20.0, 26.0, 0.0)
    for _ in range(100):
        ride(moving, trip, 0.02)
    state = np.concatenate([moving.state.q, moving.state.v, moving.state.history])
    return moving.energies(), moving.energy_residual, state, dict(moving.outputs())


@pytest.mark.parametrize("effect", EVERY_EFFECT)
def test_energy_balances_with_the_effect(effect: str) -> None:
    energies, residual, _, _ = short_run(effect)
    lost = sum(list(energies.values())[LOSSES : LOSSES + len(SPENT)])
    # The trip stores 230 J in rope and sheave and loses 5 to 30 J; the residual of the same trip without effects is
    # 4 mJ, set by the step of 4 ms and by the iteration's tolerance on the forces at the ends.
    assert lost > 1.0
    assert abs(residual) < 0.02


def test_wire_friction_takes_energy_over_a_trip() -> None:
    assert short_run("bending_hysteresis")[0]["effects.bending_hysteresis"] < -1.0


def curvature(q: np.ndarray, n: int, element: float) -> np.ndarray:
    """Angle between neighbouring elements over the element's length, at the inner nodes."""
    direction = np.arctan2(np.diff(q[n + 1 : 2 * n + 1]), np.diff(q[:n]))
    return np.diff(np.unwrap(direction)) / element


def test_wire_friction_remembers_where_it_has_slipped() -> None:
    """The slip of every node after a trip, against Dahl's equation integrated apart along the same curvatures."""
    moving, effect = rope(nominal("bending_hysteresis")), REGISTRY["bending_hysteresis"]
    trip, n = plan_s_curve(Profile(), 20.0, 26.0, 0.0), moving.n
    moving.solve_equilibrium(20.0, 30.0)
    before, slip = curvature(moving.state.q, n, moving.element), np.zeros(n - 2)
    for _ in range(500):
        ride(moving, trip, 0.004)  # one time step
        now = curvature(moving.state.q, n, moving.element)
        sense = np.sign(now - before)
        slip = sense + (slip - sense) * np.exp(-abs(now - before) / 0.1)
        before = now
    section = (effect.first_state + 1) * (n + 1)
    # The last correction of a step, below 1e-8 m, changes a curvature by up to 4e-6 of the yield curvature's 0.1 1/m.
    assert np.ptp(slip) > 1.9
    assert moving.state.history[section + 1 : section + n - 1] == pytest.approx(slip, abs=1e-3)


def test_tension_is_elastic_and_damped() -> None:
    """T = EA (L / l - 1) + c_A dL/dt / l of a segment, from its definition."""
    do = random_state({})
    forces(do)
    s, m, l = do.state, do.rope.n + 1, rope({}, STUB).element
    delta = np.array([np.diff(s.q[:m][: m - 1]), np.diff(s.q[m : 2 * m - 1])])
    rate = (delta * np.array([np.diff(s.v[: m - 1]), np.diff(s.v[m : 2 * m - 1])])).sum(0)
    length = np.hypot(*delta)
    expected = STUB.rope.axial_stiffness * (length / l - 1.0) + STUB.rope.axial_damping * rate / length / l
    # A strain of 1e-4 is known to 1e-12 of itself.
    assert do.work.w[TENSION * m : TENSION * m + m - 2] == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_airflow_inward_mirrors_airflow_outward():
    """A still rope under a rising car: the drag of air that flows outward, and that of air that flows inward as fast."""
    pushed = []
    for ratio in (0.3, -0.3):
        trial = TrialState(REGISTRY["air_drag"], nominal=True)
        trial.p[slot("effects.shaft_airflow.crossflow_ratio")] = ratio
        trial.arguments["v"][:] = 0.0
        trial.arguments["v"][0] = -2.0
        pushed.append(trial.forces()[trial.arguments["n"] + 1 :])
    outward, inward = pushed
    side = np.sign(trial.arguments["q"][trial.arguments["n"] + 1 :])
    # Nodes near the ends hang straight, so all of the air's velocity is across the rope.
    assert outward[10] * side[10] > 0.0
    assert outward[-12] * side[-12] > 0.0
    assert np.array_equal(inward, -outward)
