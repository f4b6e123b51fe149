"""The linear look at every hypothesis: what it would explain beside the plant, and where its refinement begins."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..estimation.gauss_newton import Fitted
from ..estimation.linearisation import by_effect, by_steps, directions_of, point_of, stepped
from ..estimation.mass_search import MASS, at_masses
from ..estimation.model_score import price, strain, strained
from ..estimation.per_run_phase import solve_turned
from ..estimation.weighted_least_squares import Problem, solve_in_scale
from ..hypotheses.effect_hypotheses import Hypothesis, hypotheses, of_instruments
from ..hypotheses.plant_parameters import NUISANCES
from ..prediction.parameter_point import Point
from ..prediction.replay import coarseness
from .frequency_candidates import frequencies, scanned

Floats = NDArray[np.float64]
MASSES = (-0.2, -0.1, 0.1, 0.2)  # logarithms of the rope's mass over the data sheet's
ALIKE = 0.7  # cosine above which two effects look the same in these data
CLOSE = 5.0  # misfit per datum of a fit below which looks are best taken from there


@dataclass(frozen=True)
class Screened:
    """A hypothesis after the linear look: start of its refinement, predicted misfit, its direction free of the plant's.

    `visible` is the share of its trace that the plant cannot imitate; `alternatives` are the ways in which its effect was tried.
    """

    hypothesis: Hypothesis
    start: Floats
    misfit: float
    sideways: Floats
    visible: float
    alternatives: int

    @property
    def strained(self) -> float:
        """The misfit, raised as the price and the plant's strain lower the score."""
        return strained(self.misfit, price(self.hypothesis, self.alternatives) + self.strain)

    @property
    def strain(self) -> float:
        """What the plant costs where its refinement begins."""
        return strain(self.start)

    @cached_property
    def span(self) -> Floats:
        """An orthonormal basis (N, directions) of the directions free of the plant's."""
        return np.asarray(np.linalg.qr(self.sideways)[0])


def alike(a: Screened, b: Screened) -> bool:
    """Whether two effects look the same in these data: the largest cosine between what their traces span, free of the plant's."""
    return bool(np.linalg.svd(a.span.T @ b.span, compute_uv=False)[0] > ALIKE)


def screen(
    problem: Problem, origin: Point, none: Fitted, nominal: Fitted | None = None, tried: tuple[float, ...] | None = None
) -> list[Screened]:
    """Every effect's best alternative, most promising first; effects that `origin` has, or that are ruled out, are not.

    Looks are taken from the fit `none`, and from `nominal` as well where that fit misses much: it is bent for what it lacks.
    `tried` are frequencies [Hz] for effects that have one; by default promising ones.
    """
    left_out = {key.split(".")[1] for key in origin.effects} | problem.ruled_out
    known = hypotheses(problem.campaign.model, promising_frequencies(problem, none) if tried is None else tried)
    columns = dict(_effect_columns(problem, origin, [one for one in known if one.effect not in left_out]))
    faults = of_instruments(problem.campaign.channels)
    columns |= {one: by_effect(problem, one, origin, none.predictions) for one in faults if one.effect not in left_out}
    return best_of_each(looks_from(problem, columns, none, nominal))


def best_of_each(looks: Sequence[Screened]) -> list[Screened]:
    """Every effect's most promising look, the most promising effect first."""
    best: dict[str, Screened] = {}
    for look in sorted(looks, key=lambda one: one.strained):
        best.setdefault(look.hypothesis.effect, look)
    return list(best.values())


def promising_frequencies(problem: Problem, fitted: Fitted) -> tuple[float, ...]:
    """Frequencies [Hz] to try for effects that have one: where swaying would explain most, and the residual's peaks."""
    peaks, swayed = frequencies(problem, fitted.predictions), scanned(problem, fitted, coarseness(problem.campaign.model))
    return tuple(dict.fromkeys([*swayed, *peaks]))


def looks_from(problem: Problem, columns: Mapping[Hypothesis, Floats], none: Fitted, nominal: Fitted | None) -> list[Screened]:
    """All looks at hypotheses with their derivatives (N, directions).

    What each would leave is told as a share of what `none` leaves.
    """
    looks: list[Screened] = []
    for at in [none] if nominal is None or none.misfit < CLOSE * len(problem.data) else [none, nominal]:
        plain = solve_in_scale(problem.residual(at.predictions), at.by, directions_of(at.hypothesis), at.coefficients)
        share = none.misfit / plain.misfit
        looks += [look for one, by in columns.items() for look in _looks_at(problem, one, by, columns, at, share)]
    return looks


def _effect_columns(problem: Problem, origin: Point, tried: Sequence[Hypothesis]) -> Iterator[tuple[Hypothesis, Floats]]:
    """Derivatives (N, directions) of every hypothesis that can be simulated, all replays side by side.

    What an effect changes is seen on a coarse mesh as well.
    """
    points = [origin, *(point for one in tried for point in stepped(origin, one))]
    moved = iter(problem.attempts(*points, coarse=coarseness(problem.campaign.model)))
    if (before := next(moved)) is None:
        return
    for one in tried:
        found = [at for _ in one.directions if (at := next(moved)) is not None]
        if len(found) == len(one.directions):
            yield one, by_steps(problem, one, before, found)


def _looks_at(
    problem: Problem, one: Hypothesis, by: Floats, among: Mapping[Hypothesis, Floats], at: Fitted, share: float
) -> Iterator[Screened]:
    """The hypothesis with one phase for all runs and, where it has a phase, with one for each, seen from the fit `at`.

    Misfits are multiplied by `share`.
    """
    others, residual, begin = directions_of(at.hypothesis), problem.residual(at.predictions), at.coefficients
    weights = np.vstack([at.by, np.diag([1.0 / p.prior for p in others])])
    padded = np.vstack([by, np.zeros((len(others), by.shape[1]))])
    sideways = (padded - weights @ np.linalg.lstsq(weights, padded, rcond=None)[0])[: len(by)]
    visible = float(np.linalg.norm(sideways)) / max(float(np.linalg.norm(by)), 1e-300)
    same = sum(other.effect == one.effect for other in among)
    start = np.concatenate([begin, np.zeros(by.shape[1])])
    solution = solve_in_scale(residual, np.hstack([at.by, by]), [*others, *one.directions], start)
    yield Screened(one, solution.coefficients, share * solution.misfit, sideways, visible, same)
    if one.polar and len(problem.runs) > 1:
        turned, found, misfit = solve_turned(problem, at, by, one)
        yield Screened(turned, found, share * misfit, sideways, visible, 2 * same)


# -- at other masses of the rope ----------------------------------------------------------------------
#
# A large effect swings the rope, and where the model's mass is not the rope's, its swings go out of step with those
# measured: from there its trace looks like nothing that was measured, and the misfit without it does not tell the
# mass either.


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
