"""What each effect does to a rope in motion, against its formula written out anew with numpy."""

from collections.abc import Callable

import numpy as np
import pytest

from comprope.drive.trajectory.s_curve import TrajectoryPoint
from comprope.rope.compiler.workspace import RopeWorkspace
from comprope.rope.effects import REGISTRY
from comprope.rope.parameters.parameter_vector import ELEMENT, C, K
from comprope.rope.runtime.array_layout import ELASTIC, FRICTION_LOSS, NORMAL_LOSS

from .random_rope import COMPANIONS, TIME, forces, nominal, random_state
from .rope_tower import STUB, rope, way

HELD = TrajectoryPoint(0.5)
EI, DIAMETER = STUB.rope.bending_stiffness, STUB.rope.diameter


class Bent:
    """Geometry of a bent rope: unit tangents and lengths of its elements, velocities of its nodes."""

    def __init__(self, do: RopeWorkspace) -> None:
        n = do.rope.n
        q, v = (array.reshape(2, n + 1) for array in (do.state.q, do.state.v))
        self.v, self.spin, self.rise = v[:, :n], v[1, n], v[0, n]
        self.q, self.depth, self.angle = q[:, :n], q[0, n], q[1, n]
        self.side = np.sign(q[1, :n])
        step = np.diff(q[:, :n], axis=1)
        self.length = np.hypot(*step)
        self.tangent = step / self.length
        self.element = float(do.rope.p[ELEMENT])

    @property
    def curvature(self) -> np.ndarray:
        """Angle between neighbouring elements over the element's length, at the inner nodes."""
        return np.diff(np.unwrap(np.arctan2(self.tangent[1], self.tangent[0]))) / self.element

    def of_moments(self, moment: np.ndarray) -> np.ndarray:
        """Forces (2, n + 1) of bending moments at the inner nodes: the shear Q = (M_e - M_e+1) / L of each element."""
        whole = np.concatenate([[0.0], moment, [0.0]])
        shear = -np.diff(whole) / self.length * np.array([-self.tangent[1], self.tangent[0]])
        found = np.zeros((2, self.length.size + 2))
        found[:, : shear.shape[1]] += shear
        found[:, 1 : shear.shape[1] + 1] -= shear
        return found

    def drag(self, ratio: float) -> np.ndarray:
        """Air drag (2, n + 1): -1/2 rho C_d d l |u| u n by the velocity u normal to the rope, in a wind that blows outward."""
        normal = 0.5 * np.array([-self.tangent[1, :-1] - self.tangent[1, 1:], self.tangent[0, :-1] + self.tangent[0, 1:]])
        wind = ratio * -self.v[0, 0] * self.side[1:-1]  # the car rises by -v[0, 0]
        u = normal[0] * self.v[0, 1:-1] + normal[1] * (self.v[1, 1:-1] - wind)
        found = np.zeros((2, self.length.size + 2))
        found[:, 1:-2] = -0.5 * 1.2 * 1.1 * DIAMETER * self.element * np.abs(u) * u * normal
        return found

    def beside(self, length: float) -> np.ndarray:
        """Share of each node in what is beside the counterweight's side at 0.5 m: cos^2 over `length` to either side."""
        away = np.minimum(np.abs(-self.q[0] - 0.5) / length, 1.0)
        found = np.where(self.q[1] > 0.0, np.cos(0.5 * np.pi * away) ** 2 * self.element / length, 0.0)
        found[[0, -1]] = 0.0  # the ends are held
        return found

    def pushed(self, across: np.ndarray, along: np.ndarray) -> np.ndarray:
        """Forces (2, n + 1) on the nodes."""
        return np.pad(np.array([along, across]), ((0, 0), (0, 1)))

    def on_sheave(self, force: float = 0.0, torque: float = 0.0) -> np.ndarray:
        """A force and a torque on the sheave."""
        found = np.zeros((2, self.length.size + 2))
        found[:, -1] = force, torque
        return found


def slipped(bent: Bent, do: RopeWorkspace) -> np.ndarray:
    """Dahl's variable after the curvature has changed from that in the history to the present one."""
    first, m = REGISTRY["bending_hysteresis"].first_state, do.rope.n + 1
    before, z = (do.state.history[(first + k) * m + 1 : (first + k + 1) * m - 2] for k in (0, 1))
    sense = np.sign(bent.curvature - before)
    return sense + (z - sense) * np.exp(-np.abs(bent.curvature - before) / 0.1)


def coulomb(size: float, v: float, v0: float) -> float:
    return -size * v / np.hypot(v, v0)


def held(speed: float) -> float:
    """A tie-down's force: 1e3 N s/m, and 1e5 N s/m above 0.3 m/s of a rise, taking hold over 10 mm/s."""
    over = max(speed - 0.3, 0.0)
    return 1e3 * speed + 1e5 * over**2 / (over + 0.01)


def stuck(speed: float) -> float:
    """A sticky guide's force: 10 N in sliding and 20 N more at breakaway, which fades over 2 mm/s."""
    return coulomb(10.0 + 20.0 * np.exp(-((speed / 2e-3) ** 2)), speed, 5e-4)


def brushed(bent: Bent) -> np.ndarray:
    """20 N/m and 5 N s/m over 0.2 m."""
    return bent.pushed(-bent.beside(0.2) * (20.0 * (bent.q[1] - STUB.sheave.radius) + 5.0 * bent.v[1]), 0.0 * bent.v[0])


def guided(bent: Bent) -> np.ndarray:
    """100 N/m outward where the rope is less than 20 mm out, over 1 m, and friction of 0.2."""
    across = 100.0 * bent.beside(1.0) * np.maximum(0.02 - (bent.q[1] - STUB.sheave.radius), 0.0)
    return bent.pushed(across, -0.2 * across * bent.v[0] / np.hypot(bent.v[0], 0.02))


def whirled(bent: Bent) -> np.ndarray:
    """0.1 kg m, one radian from straight down at the start."""
    turned = bent.angle + 1.0
    return bent.on_sheave(0.1 * bent.spin**2 * np.cos(turned), -0.1 * STUB.shaft.gravity * np.sin(turned))


# The force (2, n + 1) that an effect adds at its nominal values: 1.1 for the drag coefficient, 5 N.m, 0.1 N.m.s, 20 N ...
FORMULAS: dict[str, Callable[[Bent, RopeWorkspace], np.ndarray]] = {
    "air_drag": lambda bent, do: bent.drag(0.0),
    "shaft_airflow": lambda bent, do: bent.drag(0.3) - bent.drag(0.0),
    "intrinsic_curvature": lambda bent, do: bent.of_moments(np.full(bent.length.size - 1, -EI * 0.1)),
    "bending_hysteresis": lambda bent, do: bent.of_moments(1.0 * slipped(bent, do)),
    "bearing_friction": lambda bent, do: bent.on_sheave(torque=coulomb(5.0, bent.spin, 0.01) - 0.1 * bent.spin),
    "guide_friction": lambda bent, do: bent.on_sheave(coulomb(20.0, bent.rise, 5e-4)),
    "sheave_damper": lambda bent, do: bent.on_sheave(-1e4 * bent.rise),
    "sheave_unbalance": lambda bent, do: whirled(bent),
    "jammed_seal": lambda bent, do: bent.on_sheave(torque=-0.05 * bent.angle),
    "jammed_guide": lambda bent, do: bent.on_sheave(-1e4 * (bent.depth - STUB.shaft.pit)),
    "sticky_guide": lambda bent, do: bent.on_sheave(stuck(bent.rise)),
    "rope_brush": lambda bent, do: brushed(bent),
    "rope_guide": lambda bent, do: guided(bent),
    "tie_down": lambda bent, do: bent.on_sheave(-held(bent.rise)),
}


@pytest.mark.parametrize("effect", FORMULAS)
def test_effect_pushes_as_its_formula_says(effect: str) -> None:
    acting, absent = random_state(nominal(effect)), random_state(COMPANIONS.get(effect, {}))
    acting.state.v[:] *= 10.0  # velocities of 2 m/s, so that the drag is not lost in the rounding of the other forces
    absent.state.from_bytes(acting.state.to_bytes())
    found = (forces(acting) - forces(absent)).reshape(2, -1)
    expected = FORMULAS[effect](Bent(acting), acting)
    assert np.abs(expected).max() > 1e-3  # N, else nothing would be compared
    # Forces of up to 1e5 N, whose rounding is 1e-10 N; a curvature from a sine to its ninth order is good to 1e-9 of itself.
    assert found == pytest.approx(expected, rel=1e-7, abs=1e-9)


SWAY, OFFSET = nominal("building_sway"), nominal("attachment_offset")


@pytest.mark.parametrize(("effect", "changes"), [("building_sway", SWAY), ("attachment_offset", OFFSET)])
def test_effect_moves_the_ends_as_its_formula_says(effect: str, changes: dict[str, float]) -> None:
    """Sway grows from nothing at the pit's bottom to its amplitude at the top landing; offsets are outward."""
    do = random_state(changes | ({"effects.attachment_offset.counterweight": 0.02} if effect == "attachment_offset" else {}))
    heights, n, amplitude = (0.9, 0.2), do.rope.n, SWAY["effects.building_sway.amplitude"]
    path = np.zeros((4, 6))
    path[[0, 2], 0], path[[0, 2], 3] = (-heights[0], -heights[1]), (-heights[0], -heights[1])
    do.ends.path[:] = path.ravel()
    do.place_ends(t=TIME, dt=1.0, s=0.0)
    swing = amplitude * np.sin(2.0 * np.pi * 0.2 * TIME + 1.0) / (STUB.shaft.height + STUB.shaft.pit)
    expected = {
        "building_sway": [swing * (height + STUB.shaft.pit) for height in heights],
        "attachment_offset": [-0.01, 0.02],
    }[effect]
    assert do.state.q[[n + 1, 2 * n]] == pytest.approx(expected, rel=1e-12)


def test_every_effect_is_compared_with_a_formula() -> None:
    elsewhere = {
        "building_sway", "attachment_offset", "encoder_scale", "sheave_eccentricity", "sloped_guide", "end_stops",
        "shaft_walls",
    }  # fmt: skip
    assert elsewhere | set(FORMULAS) == set(REGISTRY)


SHAFT = {"shaft.height": 4.0, "rope.bending_stiffness": 2.0}


def hung(changes: dict[str, float]) -> tuple[float, float, float]:
    """Height of the axle, and outward displacements of both sides beside it, of a rope at rest in a shaft of 4 m."""
    one = rope(SHAFT | changes)
    one.solve_equilibrium(2.0, 2.0)
    axle = one.sheave()["sheave_displacement"]
    return axle, *(one.lateral_displacement(side, axle - 1.1)[0] for side in ("car", "counterweight"))


def test_an_eccentric_groove_lifts_the_axle_and_shifts_the_rope_towards_its_centre() -> None:
    """Phase zero puts the groove's centre below the axle, a quarter of a turn on towards the car."""
    e, plain = 1e-3, hung({})
    below, aside = (
        np.subtract(hung({"effects.sheave_eccentricity.eccentricity": e, "effects.sheave_eccentricity.phase": phase}), plain)
        for phase in (0.0, np.pi / 2.0)
    )
    # The sides lean by e over 3 m, which shortens them by 1e-7 m; where they are seen, 0.4 m above the axle's height, the
    # groove's shift has fallen by as much as the sensor is nearer to the ends, a seventh, and a little by the bending.
    assert below == pytest.approx([e, 0.0, 0.0], abs=3e-5)
    assert aside[0] == pytest.approx(0.0, abs=1e-5)
    assert aside[1:] == pytest.approx([0.85 * e, -0.85 * e], rel=0.1)


def test_a_sloped_guide_shifts_the_rope_by_its_slope_times_how_far_the_axle_has_sunk() -> None:
    """Both sides move towards the counterweight as by an eccentric groove."""
    plain = hung({})
    sunk = np.array(hung({"effects.sloped_guide.slope": 5.0}))
    shift = -5.0 * sunk[0]
    assert shift > 5e-4  # m
    assert sunk[0] == pytest.approx(plain[0], rel=0.02)
    assert sunk[1:] - plain[1:] == pytest.approx([-0.85 * shift, 0.85 * shift], rel=0.1)


# Those that act on a rope at rest: a building that sways moves its ends, an eccentric or unbalanced sheave turns under weight.
STILL = [effect for effect in REGISTRY if effect not in ("building_sway", "sheave_eccentricity", "sheave_unbalance")]


@pytest.mark.parametrize("effect", STILL)
def test_a_rope_hung_with_an_effect_stays_at_rest(effect: str) -> None:
    """Coulomb forces vanish without velocity, slip of the wires begins at zero, and settling knows of every other force."""
    one = rope(nominal(effect), STUB)
    one.solve_equilibrium(0.5, 0.5)
    before, path = one.state.q.copy(), way(STUB.sheave.radius, STUB.shaft.height, *(2 * [HELD]))
    if effect == "attachment_offset":
        assert one.state.q[[one.n + 1, 2 * one.n]] == pytest.approx([-0.41, 0.41], abs=1e-12)
    one.step(0.02, path)
    # Settled to 1e-11 m; what that leaves of forces moves the rope by less than the tolerance of a time step, 1e-8 m.
    assert np.abs(one.state.q - before).max() < 1e-8


@pytest.mark.parametrize("changes", [{}, nominal("sheave_eccentricity") | {"effects.sheave_eccentricity.eccentricity": 0.02}])
def test_the_contact_stores_and_loses_what_it_takes(changes: dict[str, float]) -> None:
    """The forces of the same rope without a contact stiffness and damping are taken off: what is left is the contact's."""
    do, apart = random_state(changes), random_state(changes)
    apart.state.from_bytes(do.state.to_bytes())
    apart.rope.p[[K, C]] = 0.0
    contact, v, h, stored = forces(do) - forces(apart), do.state.v.copy(), 1e-8, []
    lost = do.work.contact[NORMAL_LOSS] + do.work.contact[FRICTION_LOSS]
    for side in (h, -h):
        do.state.q[:] += side * v
        forces(do)
        stored.append(do.work.contact[ELASTIC])
        do.state.q[:] -= side * v
    # Energies of a joule, differenced over 10 ns of motion, carry 1e-8 W of rounding.
    assert contact @ v == pytest.approx(-(stored[0] - stored[1]) / (2.0 * h) - lost, rel=1e-6, abs=1e-5)
    assert lost > 1.0  # W
