"""Every effect seen from other masses of the rope.

A large effect swings the rope, and where the model's mass is not the rope's, its swings go out of step with those measured: from
there its trace looks like nothing that was measured, and the misfit without it does not tell the mass either.
"""

from collections.abc import Iterator
from dataclasses import replace

from .fit import Fitted
from .hypotheses import NUISANCES
from .in_step import MASS, at_masses
from .linear import point_of
from .point import Point
from .problem import Problem
from .screen import Screened, best_of_each, screen
from .spectrum import frequencies

MASSES = (-0.2, -0.1, 0.1, 0.2)  # logarithms of the rope's mass over the data sheet's


def seen_from_elsewhere(problem: Problem, origin: Point, begun: Fitted) -> list[Screened]:
    """Every effect's best look from another mass, most promising first; `begun` has the derivatives by the plant as stated."""
    looks: list[Screened] = []
    for stand in _stands(problem, begun, origin):
        # Where a rope is shaken it answers at that frequency, whatever its mass.
        looks += screen(problem, _beside(origin, stand), stand, tried=frequencies(problem, stand.predictions))
    return best_of_each(looks)


def _stands(problem: Problem, begun: Fitted, origin: Point) -> Iterator[Fitted]:
    """The model with other masses; its misfit is that with all else refitted, by the derivatives of `begun`."""
    for x, predictions, solution in at_masses(problem, begun, origin, MASSES):
        point = point_of(begun.hypothesis, list(x), origin)
        yield replace(begun, coefficients=x, point=point, predictions=predictions, misfit=solution.misfit)


def _beside(origin: Point, stand: Fitted) -> Point:
    """Where effects' derivatives are taken for a stand: at its mass."""
    name = NUISANCES[MASS].name
    return replace(origin, plant=dict(origin.plant) | {name: float(stand.coefficients[MASS])})
