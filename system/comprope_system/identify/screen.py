"""The linear look at every hypothesis: what it would explain beside the plant, and where its refinement begins."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import exp, log

import numpy as np
from numpy.typing import NDArray

from .fit import Fitted
from .hypotheses import NUISANCES, Direction, Hypothesis, hypotheses, of_instruments
from .linear import by_effect, unit_points
from .point import Point, Predictions
from .problem import Problem, solve_in_scale
from .spectrum import frequencies
from .turning import solve_turned

Floats = NDArray[np.float64]
LOOKS = 200.0  # independent looks that a campaign is worth
PRICE = 2.5  # about half the logarithm of LOOKS: of the score, for each parameter of an effect
TURN = 1.0  # the same, for each run's own phase
COARSEST = 0.3  # of the sheave's radius: elements of a first look


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
        """The misfit, raised as the price lowers the score."""
        return self.misfit * exp(2.0 * price(self.hypothesis, self.alternatives) / LOOKS)


def price(hypothesis: Hypothesis, alternatives: int) -> float:
    """What the score of a hypothesis is lowered by for all that was free to choose."""
    turns = sum(len(part.turned) for part in hypothesis.parts or (hypothesis,))
    return PRICE * (1 + len(hypothesis.directions) - turns) + TURN * turns + log(alternatives)


def screen(problem: Problem, origin: Point, nominal: Predictions, beside: Floats, none: Fitted) -> list[Screened]:
    """Every effect's best alternative, most promising first; effects that `origin` has are left out.

    `nominal` are the predictions at `origin`, `beside` (N, k) the derivatives there by the plant and by effects it has.
    """
    present = {key.split(".")[1] for key in origin.effects}
    known = hypotheses(problem.campaign.model, frequencies(problem, none.predictions))
    tried = [one for one in known if one.effect not in present]
    columns = dict(_effect_columns(problem, origin, tried))
    faults = of_instruments(problem.campaign.channels)
    columns |= {one: by_effect(problem, one, origin, nominal) for one in faults if one.effect not in present}
    residual = problem.data - problem.whitened(nominal)
    best: dict[str, Screened] = {}
    looks = [look for one, by in columns.items() for look in looks_at(problem, one, residual, beside, by, columns)]
    for look in sorted(looks, key=lambda one: one.strained):
        best.setdefault(look.hypothesis.effect, look)
    return list(best.values())


def _effect_columns(problem: Problem, origin: Point, tried: Sequence[Hypothesis]) -> Iterator[tuple[Hypothesis, Floats]]:
    """Derivatives (N, directions) of every hypothesis that can be simulated, all replays side by side.

    What an effect changes is seen on a coarse mesh as well.
    """
    points = [origin, *(point for one in tried for point in unit_points(origin, one))]
    moved = iter(problem.attempts(*points, coarse=coarseness(problem)))
    if (before := next(moved)) is None:
        return
    y = problem.whitened(before)
    for one in tried:
        found = [next(moved) for _ in one.directions]
        if all(at is not None for at in found):
            yield one, np.column_stack([problem.whitened(at) - y for at in found if at is not None])


def coarseness(problem: Problem) -> float:
    """How much longer elements may be for a first look: twice, where that still bends round the sheave."""
    model = problem.campaign.model
    return 2.0 if 2.0 * model.rope.element_length <= COARSEST * model.sheave.radius else 1.0


def looks_at(
    problem: Problem, one: Hypothesis, residual: Floats, beside: Floats, by: Floats, among: dict[Hypothesis, Floats]
) -> Iterator[Screened]:
    """The hypothesis with one phase for all runs and, where it has a phase, with one for each."""
    # Columns beyond the plant's belong to effects that are there already.
    others = [*NUISANCES, *(Direction("present", {}, 3.0) for _ in range(beside.shape[1] - len(NUISANCES)))]
    weights = np.vstack([beside, np.diag([1.0 / p.prior for p in others])])
    padded = np.vstack([by, np.zeros((len(others), by.shape[1]))])
    sideways = (padded - weights @ np.linalg.lstsq(weights, padded, rcond=None)[0])[: len(by)]
    visible = float(np.linalg.norm(sideways)) / max(float(np.linalg.norm(by)), 1e-300)
    same = sum(other.effect == one.effect for other in among)
    solution = solve_in_scale(residual, np.hstack([beside, by]), [*others, *one.directions])
    yield Screened(one, solution.coefficients, solution.misfit, sideways, visible, same)
    if one.polar and len(problem.runs) > 1:
        turned, start, misfit = solve_turned(problem, residual, beside, others, by, one)
        yield Screened(turned, start, misfit, sideways, visible, 2 * same)
