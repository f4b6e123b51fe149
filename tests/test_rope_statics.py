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
from comprope.rope.elastica import angle  # noqa: F401
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
    hung.settle(0.0, model.shaft.height)
    rho, radius, stiffness = model.rope.mass_per_length, model.sheave.radius, model.rope.bending_stiffness
    tension = axle_tension(model.sheave.mass, rho, radius)
    axle = hung.outputs()["sheave_displacement"] - model.shaft.pit
    gamma, above = rho * G / tension, 3.0
    string = 1.0 - log(1.0 + gamma * above) / log(1.0 + gamma * (model.shaft.height - axle))
    seen = hung.lateral_displacement("counterweight", axle + above)[0]
    return seen / string / (stiffness / (2.0 * radius * tension)), gamma * sqrt(stiffness / tension)


# -- offset where the rope leaves the sheave -----------------------------------------------------


@pytest.mark.parametrize("change", [{}, {"rope.bending_stiffness": 5.0}, {"sheave.radius": 0.8}, {"sheave.mass": 30.0}])
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
