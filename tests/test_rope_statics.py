"""The suspended shape against closed forms and an independent solution.

Offset of a rope that leaves the sheave. A weightless rope of bending stiffness EI under tension T
leaves a frictionless circle of radius r at the curvature 1/r and straightens; the first integral of
the elastica gives its offset from the vertical through the sheave's side exactly, EI / (2 r T). The
rope's own weight makes T grow by rho g lambda along the boundary layer lambda = sqrt(EI / T), which
lessens the offset to first order by half of gamma lambda, gamma = rho g / T, where T is the tension at
the height of the axle. Higher up the rope hangs as a string, so the offset falls as ln T to zero at
the pinned end.
"""

from math import log, pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.interpolate import CubicSpline

from .rope_tower import TOWER, rope

G = TOWER.shaft.gravity
# A rope in a short shaft above a deep pit, on a groove so hard that it gives by less than a micrometre.
DEEP = {"shaft.height": 10.0, "shaft.pit": 3.0, "contact.stiffness": 1e9, "rope.element_length": 0.01}


def axle_tension(mass: float, rho: float, radius: float) -> float:
    """Tension where the rope passes the axle's height: half the weight of sheave and wrapped rope."""
    return 0.5 * G * (mass + rho * pi * radius)


def offset_ratio(changes: dict[str, float]) -> tuple[float, float]:
    """Offset at the sheave over EI / (2 r T), from a reading 3 m above the axle, and gamma lambda."""
    hung = rope(DEEP | changes)
    model = hung.model
    hung.solve_equilibrium(0.0, model.shaft.height)
    rho, radius, stiffness = model.rope.mass_per_length, model.sheave.radius, model.rope.bending_stiffness
    tension = axle_tension(model.sheave.mass, rho, radius)
    axle = hung.outputs()["sheave_displacement"] - model.shaft.pit
    gamma, above = rho * G / tension, 3.0
    string = 1.0 - log(1.0 + gamma * above) / log(1.0 + gamma * (model.shaft.height - axle))
    seen = hung.lateral_displacement("counterweight", axle + above)[0]
    return seen / string / (stiffness / (2.0 * radius * tension)), gamma * sqrt(stiffness / tension)


# -- offset where the rope leaves the sheave -----------------------------------------------------


@pytest.mark.parametrize("change", [{}, {"rope.bending_stiffness": 5.0}, {"sheave.radius": 0.8}, {"sheave.mass": 300.0}])
def test_offset_of_a_light_rope_is_exact(change: dict[str, float]) -> None:
    ratio, gamma_lambda = offset_ratio({"rope.mass_per_length": 0.05} | change)
    # Elements of 1 cm, 1/9 of the boundary layer at worst; gravity's share is taken off.
    assert ratio + 0.5 * gamma_lambda == pytest.approx(1.0, abs=5e-4)


@pytest.mark.parametrize("stiffness", [40.0, 20.0, 10.0])
@pytest.mark.parametrize("rho", [1.2, 4.8])
def test_gravity_lessens_the_offset_to_first_order(rho: float, stiffness: float) -> None:
    ratio, gamma_lambda = offset_ratio({"rope.mass_per_length": rho, "rope.bending_stiffness": stiffness})
    # gamma lambda is at most 0.02 here; what is of second order in it, and in lambda / r, is 10 % of the first.
    assert (ratio - 1.0) / gamma_lambda == pytest.approx(-0.5, abs=0.05)


def test_offset_deviates_less_the_softer_the_rope() -> None:
    """First order in lambda, so the deviation falls as the square root of EI."""
    soft, stiff = (1.0 - offset_ratio({"rope.mass_per_length": 4.8, "rope.bending_stiffness": one})[0] for one in (10.0, 40.0))
    assert log(stiff / soft) / log(4.0) == pytest.approx(0.5, abs=0.05)


def test_a_soft_groove_lets_the_rope_in() -> None:
    """Penetration is T / (r k), so that the rope leaves a circle that much smaller: first order in 1 / k."""
    hard, soft, softer = (offset_ratio({"rope.mass_per_length": 0.05, "contact.stiffness": one})[0] for one in (1e10, 4e7, 2e7))
    assert (hard - softer) / (hard - soft) == pytest.approx(2.0, abs=0.1)


def test_offset_at_the_tower_mesh() -> None:
    """Elements of 5 cm, a quarter of the boundary layer, stay within half a percent (0.2 mm)."""
    ratio, gamma_lambda = offset_ratio({"rope.element_length": 0.05})
    assert ratio == pytest.approx(1.0 - 0.5 * gamma_lambda, abs=5e-3)


# -- tension -------------------------------------------------------------------------------------


@pytest.mark.parametrize("mass", [120.0, 2000.0])
@pytest.mark.parametrize("car", [0.0, 20.0, 47.0])
def test_ends_carry_half_the_sheave_and_their_own_rope(mass: float, car: float) -> None:
    """Without stiffness in bending the sides hang straight, so the tension grows by rho g per natural length."""
    hung = rope({"sheave.mass": mass, "rope.bending_stiffness": 0.0})
    hung.solve_equilibrium(car, 50.0 - car)
    out, model = hung.outputs(), hung.model
    rho, ends = model.rope.mass_per_length, (out["car_end_tension"], out["counterweight_end_tension"])
    # The last correction, 1e-11 m, times EA / l leaves a millinewton.
    assert sum(ends) == pytest.approx(G * (mass + rho * model.rope_length), abs=2e-3)
    # Both sides have the same tension at the axle, so they differ by the weight of the rope that one is longer by,
    # (50 m - 2 car) as it hangs, less its stretch. Nodes that sit unevenly on the groove hold 1e-4 of the tension.
    tension = axle_tension(mass, rho, model.sheave.radius)
    longer = (50.0 - 2.0 * car) / (1.0 + tension / model.rope.axial_stiffness)
    assert ends[1] - ends[0] == pytest.approx(rho * G * longer, abs=2e-4 * tension)


def test_stretch_follows_the_tension_of_each_element() -> None:
    """The height that a straight side spans is the sum of l (1 + T / EA), T from the end downwards."""
    hung = rope({"rope.bending_stiffness": 0.0})
    hung.solve_equilibrium(0.0, 50.0)
    n, l, model = hung.n, hung.element, hung.model
    k = np.arange(round(40.0 / l))
    tension = hung.outputs()["counterweight_end_tension"] - model.rope.mass_per_length * G * l * (k + 0.5)
    spanned = hung.state.q[n - 1 - k.size] - hung.state.q[n - 1]
    # The groove gives by 0.1 mm, which tilts the side by 2e-6 rad and takes 1e-10 m; the tension is known to 1 mN.
    assert spanned == pytest.approx(float(np.sum(l * (1.0 + tension / model.rope.axial_stiffness))), abs=1e-8)


# -- a sheave too light to bend the rope round it --------------------------------------------------


def free_loop(mass: float, stiffness: float, height: float, length: float) -> CubicSpline:
    """Right half of a loop that carries a weight at its lowest point: (x down, y) by arc length from there.

    Elastica with gravity and stretch: EI phi'' = -(1 + T/EA) (V cos phi - H sin phi), where phi is the
    slope from the horizontal, V = M g / 2 + rho g s the force that pulls up and H an unknown pull sideways.
    """
    rho, radius, ea = TOWER.rope.mass_per_length, TOWER.sheave.radius, TOWER.rope.axial_stiffness

    def slopes(s: np.ndarray, z: np.ndarray, sideways: np.ndarray) -> np.ndarray:
        phi, bend, up = z[0], z[1], 0.5 * mass * G + rho * G * s
        longer = 1.0 + (sideways[0] * np.cos(phi) + up * np.sin(phi)) / ea
        moment = -longer * (up * np.cos(phi) - sideways[0] * np.sin(phi))
        return np.array([bend, moment / stiffness, longer * np.cos(phi), -longer * np.sin(phi)])

    def ends(low: np.ndarray, top: np.ndarray, sideways: np.ndarray) -> np.ndarray:
        return np.array([low[0], low[2], top[1], top[2] - radius, top[3] + height])

    s = np.concatenate([np.linspace(0.0, 3.0, 1000), np.linspace(3.0, 0.5 * length, 500)[1:]])
    bent = np.exp(-s / 0.5)
    guess = np.array([0.5 * pi * (1.0 - bent), pi * bent, radius + 0.0 * s, 0.5 * length - s - height])
    solved = solve_bvp(slopes, ends, s, guess, p=[0.0], tol=1e-8, max_nodes=100_000)
    assert solved.success
    return CubicSpline(solved.x, solved.y[[3, 2]], axis=1)


@pytest.mark.parametrize("mass", [3.0, 6.0, 10.0])
def test_free_loop_of_a_light_sheave(mass: float) -> None:
    """Below T = EI / (2 r^2), 12.7 kg here, the rope hangs wider than the sheave."""
    hung = rope({"sheave.mass": mass, "shaft.height": 10.0, "contact.stiffness": 1e8, "rope.element_length": 0.02})
    hung.solve_equilibrium(5.0, 5.0)
    n, l, length = hung.n, hung.element, hung.model.rope_length
    loop = free_loop(mass, TOWER.rope.bending_stiffness, 5.0, length)
    s = np.arange(n) * l - 0.5 * length
    s, right = s[s >= 0.0], np.flatnonzero(s >= 0.0)
    found = np.array([hung.state.q[right], hung.state.q[n + 1 + right]])
    # Nodes are point values of a curve plus l^2/24 of its second derivative (0.03 mm here); what is left is the
    # patch of contact, where the rope is pressed flat over less than an element: 0.05 mm of a loop 0.3 m wider.
    assert loop(s)[1].max() > TOWER.sheave.radius + 0.2
    assert found == pytest.approx(loop(s) - l**2 / 24.0 * loop(s, 2), abs=6e-5)


# -- what the paper states -----------------------------------------------------------------------

WEIGHTS = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9, 1.0]  # of the nominal sheave


@pytest.mark.parametrize("sensor", [0.5, 2.0, 10.0])
def test_static_displacement_grows_as_the_sheave_gets_lighter(sensor: float) -> None:
    """Fig. 4: near zero, relative to nominal, from 75 % upwards; growing below."""
    seen = []
    for weight in WEIGHTS:
        hung = rope({"sheave.mass": weight * TOWER.sheave.mass})
        hung.solve_equilibrium(0.0, 50.0)
        seen.append(hung.lateral_displacement("counterweight", sensor)[0])
    relative = (np.array(seen) - seen[-1]) / (seen[0] - seen[-1])
    assert np.all(np.diff(relative) < 0.0)
    # "Close to zero" is read as a few per cent of the largest; 75 % of the weight gives 4 to 7 % here.
    assert relative[WEIGHTS.index(0.75)] < 0.08
    assert relative[WEIGHTS.index(0.4)] > 0.15


@pytest.mark.parametrize("weight", WEIGHTS)
def test_sheave_carries_its_weight_wherever_the_car_is(weight: float) -> None:
    mass = weight * TOWER.sheave.mass
    hung = rope({"sheave.mass": mass})
    for car in np.linspace(-1.0, 51.0, 14).tolist():
        hung.solve_equilibrium(car, 50.0 - car)
        out = hung.outputs()
        # A correction of 1e-11 m on a contact of some 1e7 N/m.
        assert out["sheave_force"] == pytest.approx(mass * G, abs=1e-3)
        assert abs(out["sheave_displacement"]) < 0.4  # a light loop hangs wide, and lifts the sheave


@pytest.mark.parametrize("weight", [0.1, 0.5, 1.0])
def test_mirrored_ends_give_the_mirrored_shape(weight: float) -> None:
    hung = rope({"sheave.mass": weight * TOWER.sheave.mass})
    hung.solve_equilibrium(7.0, 43.0, (0.02, -0.01))
    n, one = hung.n, hung.state.q.copy()
    hung.solve_equilibrium(43.0, 7.0, (-0.01, 0.02))
    other = hung.state.q
    # Sums run in another order round the sheave; the last correction is below 1e-11 m.
    assert other[:n][::-1] == pytest.approx(one[:n], abs=1e-11)
    assert -other[n + 1 : 2 * n + 1][::-1] == pytest.approx(one[n + 1 : 2 * n + 1], abs=1e-11)


def test_result_does_not_depend_on_where_the_nodes_sit() -> None:
    """The car shifted by twentieths of an element: displacement and sheave move smoothly, below a laser's noise of 0.2 mm."""
    hung = rope()
    lateral, sheave = [], []
    for shift in np.linspace(0.0, hung.element, 21).tolist():
        hung.solve_equilibrium(10.0 + shift, 40.0 - shift)
        lateral.append(hung.lateral_displacement("counterweight", 0.5)[0])
        sheave.append(hung.outputs()["sheave_displacement"])
    assert np.std(lateral) < 2e-5
    assert np.std(sheave) < 5e-6


@pytest.mark.parametrize(
    "changes",
    [{}, {"sheave.mass": 60.0}, {"rope.bending_stiffness": 5.0}, {"contact.stiffness": 2e8}, {"sheave.radius": 0.72}],
    ids=["preset", "light", "limp", "hard", "wide"],
)
def test_the_sheave_rests_where_a_fine_mesh_has_it(changes: dict[str, float]) -> None:
    """Chords cut the rope short at its two bends; the natural length makes up for it, wherever the nodes sit on average."""
    heights = {}
    for element in (0.05, 0.01):
        hung = rope(changes | {"rope.element_length": element})
        found = []
        for shift in np.linspace(0.0, element, 9).tolist()[:-1]:
            hung.solve_equilibrium(10.0 + shift, 40.0 - shift)
            found.append(hung.outputs()["sheave_displacement"])
        heights[element] = float(np.mean(found))
    assert heights[0.05] == pytest.approx(heights[0.01], abs=5e-6)


def test_end_displacements_belong_to_the_shape_at_rest() -> None:
    hung = rope({"effects.attachment_offset.car": 0.01})
    hung.solve_equilibrium(0.0, 50.0, (0.02, 0.03))
    assert hung.lateral_displacement("car", 0.0)[0] == pytest.approx(0.03, abs=1e-9)
    assert hung.lateral_displacement("counterweight", 50.0)[0] == pytest.approx(0.03, abs=1e-9)


def test_axle_rests_in_the_pit_as_built() -> None:
    """The natural length puts an unstretched rope's axle `pit` below the bottom landing, for any element length."""
    stiff = {"rope.axial_stiffness": 1e9, "rope.bending_stiffness": 0.0, "contact.stiffness": 1e10, "rope.mass_per_length": 0.05}
    for element in (0.05, 0.043, 0.031):
        hung = rope(stiff | {"rope.element_length": element})
        hung.solve_equilibrium(20.0, 30.0)
        # Stretch of 600 N / 1e9 N over 26 m: 16 um.
        assert hung.outputs()["sheave_displacement"] == pytest.approx(-1.6e-5, abs=1e-5)
