"""A rope in a building that moves: ends that sway, and the inertia of a base that accelerates."""

from itertools import pairwise

import numpy as np
import pytest

from comprope.rope.simulator.cosimulation import create, interface
from comprope.rope.simulator.rope import CompensationRope

from .rope_tower import TOWER, rope

STEP = 0.02
RADIUS = TOWER.sheave.radius
CAR, COUNTERWEIGHT = 35.0, 15.0
STILL = (CAR, COUNTERWEIGHT)
AMPLITUDE, RATE = 0.3, 2.0 * np.pi / 3.1


def still_ends(out: float = 0.0) -> np.ndarray:
    """Path of ends that stay at their heights, both displaced towards the counterweight's side by `out` [m]."""
    path = np.zeros((4, 6))
    path[0, [0, 3]], path[2, [0, 3]] = -CAR, -COUNTERWEIGHT
    path[1, [0, 3]], path[3, [0, 3]] = out - RADIUS, out + RADIUS
    return path.ravel()


def shaken(acceleration: list[float]) -> CompensationRope:
    """The rope after steps between these accelerations of the base."""
    one = rope()
    one.solve_equilibrium(*STILL)
    for before, after in pairwise(acceleration):
        one.step(STEP, still_ends(), (before, after))
    return one


def test_a_base_without_acceleration_changes_no_bit() -> None:
    """A building that stands, or moves at constant speed, leaves the rope at rest relative to it."""
    plain, moved = rope(), shaken([0.0] * 11)
    plain.solve_equilibrium(*STILL)
    for _ in range(10):
        plain.step(STEP, still_ends())
    assert moved.state.to_bytes() == plain.state.to_bytes()
    assert np.abs(moved.state.v).max() < 1e-5


def test_the_force_of_inertia_leans_a_rope_as_gravity_from_the_side_does() -> None:
    """A hanging string of tension T0 + rho g z under the lateral load -rho b: at rest it bows by the hand formula."""
    b, slow, heavy = 0.05, 4.0, {"rope.external_damping": 3.0, "rope.element_length": 0.1}
    times = np.arange(0.0, 12.0, STEP)
    ramp = np.where(times < slow, 0.5 * b * (1.0 - np.cos(np.pi * times / slow)), b)
    one = rope(heavy)
    rest = rope(heavy)
    one.solve_equilibrium(*STILL)
    rest.solve_equilibrium(*STILL)
    for before, after in pairwise(ramp):
        one.step(STEP, still_ends(), (float(before), float(after)))
    # c = T0 / (rho g); from axle to end y = (b/g) (L ln(1 + z/c) / ln(1 + L/c) - z), outward on the car's side
    weight = TOWER.rope.mass_per_length * TOWER.shaft.gravity
    c, length, z = 0.5 * TOWER.sheave.mass * TOWER.shaft.gravity / weight, CAR + TOWER.shaft.pit, 15.0 + TOWER.shaft.pit
    hand = b / TOWER.shaft.gravity * (length * np.log1p(z / c) / np.log1p(length / c) - z)
    moved = one.lateral_displacement("car", 15.0)[0] - rest.lateral_displacement("car", 15.0)[0]
    assert moved == pytest.approx(hand, rel=0.03)


def test_the_work_of_inertia_balances_what_the_rope_gains() -> None:
    """The energy residual stays a small part of the work, also where the rope goes slack."""
    times = np.arange(0.0, 3.0, STEP)
    one = shaken((0.4 * np.sin(RATE * times)).tolist())
    worked = abs(one.energies()["ends"])
    assert worked > 0.5
    assert abs(one.energy_residual) < 0.02 * worked


def test_a_shaken_base_is_an_ends_motion_seen_from_another_frame() -> None:
    """Base and ends that move together, seen from the ground: the rope moves as with the base's inertia alone.

    Away from the sheave only, whose groove moves with the base: so a base that turns back is compared before waves from there
    arrive at the sensor.
    """
    times = np.arange(0.0, 0.5, STEP)
    out, speed = AMPLITUDE * (1.0 - np.cos(RATE * times)), AMPLITUDE * RATE * np.sin(RATE * times)
    acceleration = AMPLITUDE * RATE**2 * np.cos(RATE * times)
    from_base, from_ground = rope(), rope()
    for one in (from_base, from_ground):
        one.solve_equilibrium(*STILL)
    for k in range(len(times) - 1):
        from_base.step(STEP, still_ends(), (float(acceleration[k]), float(acceleration[k + 1])))
        path = still_ends().reshape(4, 6)
        for place in (1, 3):
            for at, j in ((0, k), (3, k + 1)):
                path[place, at : at + 3] += out[j], speed[j], acceleration[j]
        from_ground.step(STEP, path.ravel())
    height, moved = CAR - 3.0, float(out[-1])
    relative = from_base.lateral_displacement("car", height)[0]
    absolute = from_ground.lateral_displacement("car", height)[0]
    assert relative == pytest.approx(absolute + moved, abs=0.01 * moved)


def test_the_sheave_rises_by_half_of_the_excess_of_arc() -> None:
    """Ends aside by w: two derivations of the sheave's rise, from the shape's length and from the string's formula, agree."""
    out = 0.4
    one, rest = rope(), rope()
    one.solve_equilibrium(*STILL, outward=(-out, out))
    rest.solve_equilibrium(*STILL)
    rise = one.sheave()["sheave_displacement"] - rest.sheave()["sheave_displacement"]
    weight = TOWER.rope.mass_per_length * TOWER.shaft.gravity
    c = 0.5 * TOWER.sheave.mass * TOWER.shaft.gravity / weight
    # y = w ln(1 + z/c) / ln(1 + L/c): excess of arc = w^2 / (2 ln^2(1 + L/c)) (1/c - 1/(c + L))
    lengths = [height + TOWER.shaft.pit for height in STILL]
    by_hand = sum(out**2 / (2.0 * np.log1p(L / c) ** 2) * (1.0 / c - 1.0 / (c + L)) for L in lengths)

    def excess(found: CompensationRope) -> float:
        n, q = found.n, found.state.q
        x, y = np.diff(q[:n]), np.diff(q[n + 1 : 2 * n + 1])
        sides = q[: n - 1] < q[n]
        return float(np.sum((np.hypot(x, y) - np.abs(x))[sides]))

    by_shape = excess(one) - excess(rest)
    assert rise == pytest.approx(0.5 * by_hand, rel=0.05)
    assert by_shape == pytest.approx(by_hand, rel=0.08)


def test_the_fmu_takes_the_acceleration_of_the_base_and_its_memory_is_saved() -> None:
    """A model that is saved, run and restored goes the same way again; the input's last value is part of what is saved."""
    described = interface(TOWER)
    values = {one.name: one.start for one in described.of_role("parameter")} | {"inputs_at_end": True}
    inputs = {one.name: one.start for one in described.of_role("input")}
    inputs |= {"car_position": CAR, "counterweight_position": COUNTERWEIGHT}
    model = create(values, inputs, 0.0)
    model.step(0.0, STEP, inputs | {"base_acceleration": 1.0})
    saved = model.get_state()
    found = []
    for _ in range(2):
        model.set_state(saved)
        model.step(STEP, STEP, inputs | {"base_acceleration": 3.0})
        found.append(model.get_state())
    assert found[0] == found[1]
    again = create(values, inputs, 0.0)
    again.set_state(saved)
    again.step(STEP, STEP, inputs | {"base_acceleration": 3.0})
    assert again.get_state() == found[0]
