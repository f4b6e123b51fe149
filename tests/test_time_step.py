"""Forces, single time steps, the energy balance and the outputs, against formulas written out anew with numpy on few nodes."""

from functools import cache

import numpy as np
import pytest

from comprope.drive.trajectory.s_curve import TrajectoryPoint
from comprope.errors import InputError
from comprope.rope.runtime.kernel_arguments import State
from comprope.rope.simulator.rope import CompensationRope

from .random_rope import forces as kernel_forces
from .random_rope import random_state
from .reference_rope import ReferenceRope
from .rope_tower import STUB, rope, way

H, DAMPING = 0.004, 0.15
CHANGES = {"solver.step": H, "solver.numerical_damping": DAMPING, "rope.external_damping": 2.0, "rope.axial_damping": 200.0}
CHANGES["rope.compression_ratio"] = 1.0  # what slack rope does is in test_slack.py
BETA, GAMMA = 0.25 * (1.0 + DAMPING) ** 2, 0.5 + DAMPING
STEPS = 30


def reference(one: CompensationRope, state: State) -> ReferenceRope:
    return ReferenceRope(one.model, one.element, state.q.reshape(2, -1), state.v.reshape(2, -1))


def motion(time: float) -> TrajectoryPoint:
    """The car rises and falls by 2 cm, with an acceleration of up to 3 m/s2, from rest."""
    w = 12.0
    turned = w * time
    return TrajectoryPoint(0.5 + 0.02 * (1.0 - np.cos(turned)), 0.02 * w * np.sin(turned), 0.02 * w * w * np.cos(turned))


@cache
def shaken() -> tuple[CompensationRope, list[State], list[np.ndarray], list[dict[str, float]]]:
    """A rope in the shaft of one metre after time steps of the car's swing; states, forces and energies after each."""
    one = rope(CHANGES, STUB)
    one.solve_equilibrium(0.5, 0.5)
    states, forces, energies = [one.state.copy()], [evaluated(one)], [one.energies()]
    for k in range(STEPS):
        one.step(H, way(STUB.sheave.radius, STUB.shaft.height, motion(k * H), motion((k + 1) * H)))
        states.append(one.state.copy())
        forces.append(evaluated(one))
        energies.append(one.energies())
    return one, states, forces, energies


def evaluated(one: CompensationRope) -> np.ndarray:
    """The forces at the state reached, as the outputs have just evaluated them."""
    one.outputs()
    return one.workspace.work.f.copy()


def free(one: CompensationRope) -> np.ndarray:
    """Coordinates that move freely: all but the four of the prescribed ends."""
    return np.setdiff1d(np.arange(2 * (one.n + 1)), (0, one.n - 1, one.n + 1, 2 * one.n))


@pytest.mark.parametrize(("seed", "ratio"), [(0, 1.0), (1, 1e-3), (2, 0.1)])
def test_forces_are_those_of_the_equations(seed: int, ratio: float) -> None:
    changes = {"rope.external_damping": 2.0, "rope.compression_ratio": ratio}
    do, model = random_state(changes, seed), rope(changes, STUB)
    found = kernel_forces(do).reshape(2, -1)
    own = ReferenceRope(model.model, model.element, do.state.q.reshape(2, -1), do.state.v.reshape(2, -1))
    # Forces of up to 1e5 N from strains of 1e-3 known to 1e-13; curvature from a sine to its ninth order, good to 1e-9.
    assert np.abs(own.contact[0]).max() > 1.0
    assert found == pytest.approx(own.forces, rel=1e-8, abs=1e-6)


def test_a_step_follows_newmark_s_rule_and_balances_as_hilber_hughes_and_taylor_have_it() -> None:
    one, states, forces, _ = shaken()
    inner, mass = free(one), reference(one, states[0]).masses.ravel()
    for before, now, f0, f1 in zip(states[10:], states[11:], forces[10:], forces[11:], strict=False):
        q = before.q + H * before.v + H**2 * ((0.5 - BETA) * before.a + BETA * now.a)
        v = before.v + H * ((1.0 - GAMMA) * before.a + GAMMA * now.a)
        assert np.abs(before.a[inner]).max() > 1.0  # m/s2
        assert now.q[inner] == pytest.approx(q[inner], rel=0.0, abs=1e-13)
        assert now.v[inner] == pytest.approx(v[inner], rel=0.0, abs=1e-11)
        balance = (1.0 - DAMPING) * f1 + DAMPING * f0 - mass * now.a
        # A correction below 1e-8 m ends the iteration; the one after it would be some 1e-11 m, of 1e8 N/m. Forces change by 7 N.
        assert balance[inner] == pytest.approx(np.zeros(inner.size), abs=1e-3)


def test_stored_energies_and_losses_are_those_of_the_motion() -> None:
    """Each stored energy at each state, each loss by the trapezoidal rule over each step."""
    one, states, _, energies = shaken()
    own = [reference(one, state) for state in states]
    for state, energy in zip(own, energies, strict=True):
        for name, value in state.stored().items():
            assert energy[name] == pytest.approx(value, rel=1e-5, abs=1e-6), name
    for before, now, e0, e1 in zip(own, own[1:], energies, energies[1:], strict=False):
        for name, power in now.losses().items():
            lost = 0.5 * H * (before.losses()[name] + power)
            # Powers are those of the last iterate, whose velocities are 1e-8 m / h from those reached: some 1e-4 of the slip.
            assert e1[name] - e0[name] == pytest.approx(lost, rel=3e-3, abs=1e-7), name
    assert all(energies[-1][name] > 1e-5 for name in own[0].losses())  # J, else nothing would be compared


def test_the_ends_do_the_work_of_their_holders_and_the_energy_balances() -> None:
    one, states, _, energies = shaken()
    ends = [0, one.n - 1]
    held = [reference(one, state).holders(state.a.reshape(2, -1)) for state in states]
    for k in range(STEPS):
        moved = (states[k + 1].q - states[k].q).reshape(2, -1)[:, ends]
        work = float((0.5 * (held[k] + held[k + 1]) * moved).sum())
        assert energies[k + 1]["ends"] - energies[k]["ends"] == pytest.approx(work, rel=1e-4, abs=1e-5)
    stored = reference(one, states[-1]).stored()
    gained = sum(stored.values()) - sum(reference(one, states[0]).stored().values())
    lost = sum(energies[-1][name] for name in reference(one, states[0]).losses())
    assert one.energy_residual == pytest.approx(gained - energies[-1]["ends"] + lost, abs=1e-6)


def sideways(time: float, shaft: float, radius: float) -> np.ndarray:
    """Positions, velocities and accelerations (4, 3) of both ends, which swing sideways while they stay at their heights.

    The car's by 1 cm, the counterweight's by 2 cm, from rest: y = y_0 + b (1 - cos w t).
    """
    w, found = 12.0, np.zeros((4, 3))
    found[[0, 2], 0] = -0.5, 0.5 - shaft
    for row, place, size in ((1, -radius, 0.01), (3, radius, 0.02)):
        turned = w * time
        found[row] = place + size * (1.0 - np.cos(turned)), size * w * np.sin(turned), size * w * w * np.cos(turned)
    return found


def test_ends_that_move_sideways_do_the_work_of_their_lateral_forces() -> None:
    one = rope(CHANGES, STUB)
    one.solve_equilibrium(0.5, 0.5)
    ends, done = [0, one.n - 1], [0.0, 0.0]
    before, state = one.energies()["ends"], one.state.copy()
    for k in range(15):
        first, last = (sideways(at * H, STUB.shaft.height, STUB.sheave.radius) for at in (k, k + 1))
        one.step(H, np.hstack([first, last]).ravel())
        held = [reference(one, at).holders(at.a.reshape(2, -1)) for at in (state, one.state)]
        moved = (one.state.q - state.q).reshape(2, -1)[:, ends]
        work = 0.5 * (held[0] + held[1]) * moved
        assert one.energies()["ends"] - before == pytest.approx(float(work.sum()), rel=1e-4, abs=1e-5)
        done += np.abs(work[1])
        before, state = one.energies()["ends"], one.state.copy()
    assert min(done) > 1e-2  # J, by car and by counterweight, else nothing would be compared


def test_the_ends_are_where_their_path_ends() -> None:
    one, states, _, _ = shaken()
    for k, state in enumerate(states[1:], 1):
        car, q, v, a = motion(k * H), state.q, state.v, state.a
        assert q[[0, one.n - 1]] == pytest.approx([-car.position, car.position - 1.0], abs=1e-14)
        assert v[[0, one.n - 1]] == pytest.approx([-car.velocity, car.velocity], abs=1e-12)
        assert a[[0, one.n - 1]] == pytest.approx([-car.acceleration, car.acceleration], abs=1e-10)
        assert q[[one.n + 1, 2 * one.n]] == pytest.approx([-STUB.sheave.radius, STUB.sheave.radius], abs=1e-14)


def steps_taken(speeds: tuple[float, float, float, float], dt: float, step: float) -> int:
    """Time steps of a communication step in which car and counterweight begin and end with vertical velocities (down).

    A communication step of 0.2 s before it brings them from rest to the velocities that they begin with.
    """
    one = rope({"solver.step": step, "rope.compression_ratio": 1.0}, STUB)
    one.solve_equilibrium(0.5, 0.5)
    path, ends, taken = np.zeros((4, 6)), [0, 2], 0
    path[1], path[3] = [-STUB.sheave.radius, 0, 0] * 2, [STUB.sheave.radius, 0, 0] * 2
    path[ends, 3] = -0.5
    for duration, reached in ((0.2, speeds[::2]), (dt, speeds[1::2])):
        path[ends, :2], path[ends, 4] = path[ends, 3:5], reached
        path[ends, 3] = path[ends, 0] + 0.5 * duration * (path[ends, 1] + path[ends, 4])
        before = dict(one.count)
        one.step(duration, path.ravel())
        taken = one.count["steps"] - before["steps"] if one.count["halved"] == before["halved"] else -1
    return taken


@pytest.mark.parametrize(
    ("speeds", "dt", "step", "expected"),
    [
        ((0.0, 0.0, 0.0, 0.0), 0.02, 0.02, 1),
        ((0.0, 0.0, 0.0, 0.0), 0.035, 0.005, 7),  # 0.035 / 0.005 is a little more than 7 in floating point
        ((0.0, 0.0, 0.0, 0.0), 0.02, 0.0066, 4),
        ((0.0, -2.0, 0.0, 0.0), 0.02, 0.02, 2),  # 40 mm in 20 ms, of which a time step may have 0.6 elements of 50 mm
        ((0.0, 0.0, 0.0, -2.0), 0.02, 0.02, 2),
        ((-2.0, -1.4, 0.0, 0.0), 0.02, 0.02, 2),
        ((0.0, 0.0, -2.0, -1.4), 0.02, 0.02, 2),
        ((0.0, 2.0, 0.0, -4.0), 0.02, 0.02, 3),
        ((0.0, -0.2, 0.0, 0.0), 0.02, 0.02, 1),
    ],
)
def test_a_communication_step_has_as_many_time_steps_as_its_length_and_speed_ask_for(
    speeds: tuple[float, float, float, float], dt: float, step: float, expected: int
) -> None:
    assert steps_taken(speeds, dt, step) == expected


def test_elements_make_up_for_the_chords_at_the_sheave() -> None:
    """The rope's natural length less l^2 (L + A) / (48 R^2), see mesh.py; none where the rope hangs as a loop."""
    for mass in (STUB.sheave.mass, 2.0):
        model = rope({"sheave.mass": mass}, STUB).model
        radius, stiffness = model.sheave.radius, model.rope.bending_stiffness
        length = 2.0 * model.shaft.pit + model.shaft.height + np.pi * radius
        elements = round(length / model.rope.element_length)
        straightens = np.sqrt(stiffness / (0.5 * mass * model.shaft.gravity))
        sinks = (4.0 * stiffness / model.contact.stiffness) ** 0.25
        short = (length / elements) ** 2 * (straightens + sinks) / (48.0 * radius**2)
        loop = straightens > np.sqrt(2.0) * radius
        assert loop is np.bool_(mass == 2.0)
        assert rope({"sheave.mass": mass}, STUB).element * elements == pytest.approx(length - (0.0 if loop else short), rel=1e-14)


def test_ends_too_far_apart_to_reach_are_refused() -> None:
    """Straight sides and the half circle of 3.46 m: ends 1.4 m apart have the lower a radius above the axle."""
    one = rope({}, STUB)
    one.solve_equilibrium(0.0, 1.39)
    with pytest.raises(InputError, match="would hang the axle at"):
        one.solve_equilibrium(0.0, 1.41)
    with pytest.raises(InputError, match="would hang the axle at"):
        one.solve_equilibrium(1.41, 0.0)
