"""Which physical effect is missing: rank all hypotheses about a campaign and say what can be said.

One linearisation about the model file gives every effect's expected size and what it would explain,
plant parameters refitted beside it. The most promising are then refined on the full model. Scores
compare misfits as ratios, as if LOOKS independent looks had been taken: the discrepancy of a model is
one and the same in thousands of samples, which a plain likelihood would count as evidence each.
"""

from collections.abc import Callable
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import dataclass, replace
from math import log

import numpy as np
from numpy.typing import NDArray

from comprope.errors import SimulationError

from .campaign import Campaign
from .errors_of import nrmse
from .fit import Fitted, refine
from .hypotheses import NUISANCES, Hypothesis, together
from .linear import linearised
from .point import Point, Predictions, gathered, submit
from .present import shape_of
from .problem import Problem, pose
from .screen import LOOKS, Screened, price, screen
from .starts import best_start

Floats = NDArray[np.float64]
Say = Callable[[str], None]

UNEXPLAINED = 0.04  # of the misfit that is too much: what "none of the known effects" stands for
UNKNOWN = 10.0  # its price
ADEQUATE = 0.85  # misfit per datum below which there is nothing to explain
REFINED = 4  # hypotheses that are refined on the full model
RIVAL = 2.0  # times the best fit's misfit above which a fit is not worth its time
SECOND = 0.7  # of the misfit that the best effect may leave if a second one is to be looked for
PAIRS = 2  # second effects that are refined with the first
LEFT = 1.05  # misfit per datum above which a fit is worth another with more set free
WORTH = 0.97  # of its misfit that it must fall to
ALIKE = 0.7  # cosine above which two effects look the same in these data


@dataclass(frozen=True)
class Candidate:
    """One effect in the ranking."""

    fitted: Fitted
    score: float
    probability: float
    refined: bool
    visible: float
    least: dict[str, float]

    @property
    def hypothesis(self) -> Hypothesis:
        """What the effect does."""
        assert self.fitted.hypothesis is not None
        return self.fitted.hypothesis


@dataclass(frozen=True)
class Diagnosis:
    """The outcome: `none` is the refitted model without a new effect; probabilities include "adequate" and "unknown"."""

    campaign: Campaign
    problem: Problem
    nominal: Predictions
    none: Fitted
    ranking: tuple[Candidate, ...]
    probabilities: dict[str, float]
    alike: tuple[tuple[str, str], ...]
    verdict: str | None
    kind: str


def diagnose(campaign: Campaign, executor: Executor, say: Say = lambda _: None, base: Point | None = None) -> Diagnosis:
    """Rank all effects against a campaign; `base` has effects that are in the model already."""
    origin = base or Point()
    runs = campaign.of_role("fit")
    say("the model as it is")
    nominal = gathered(runs, submit(campaign, runs, origin, executor))
    problem = pose(campaign, runs, executor, nominal)
    say("plant parameters")
    begun = linearised(problem, None, np.zeros(len(NUISANCES)), origin)
    none = refine(problem, None, np.zeros(len(NUISANCES)), origin, begun=begun)
    say("every effect, linearised")
    screened = screen(problem, origin, nominal, begun[1], none)
    found = _refined(problem, origin, screened, none, say)
    judged = _judged(campaign, problem, nominal, none, found)
    return _second_look(judged, found, origin, say) if judged.kind == "unknown_effect" else judged


def _second_look(judged: Diagnosis, found: list["Trial"], origin: Point, say: Say) -> Diagnosis:
    """No effect alone explains the data: add a second one to the best, and judge again with the pair among the rivals."""
    best = min((one for one in found if one[2]), key=lambda one: one[1].misfit, default=None)
    if best is None or best[1].misfit > SECOND * judged.none.misfit:
        return judged
    problem, first = judged.problem, best[1]
    assert first.hypothesis is not None
    say(f"{first.hypothesis.effect} and a second effect, linearised")
    screened = screen(problem, first.point, first.predictions, first.by, first)
    pairs = [_pair(problem, origin, first, one, say) for one in screened[:PAIRS]]
    return _judged(judged.campaign, problem, judged.nominal, judged.none, [*found, min(pairs, key=lambda one: one[1].misfit)])


def _pair(problem: Problem, origin: Point, first: Fitted, second: Screened, say: Say) -> "Trial":
    """Both effects refined together on the full model."""
    assert first.hypothesis is not None
    both = together(first.hypothesis, second.hypothesis)
    say(f"{both.effect}, on the full model")
    start = np.concatenate([first.coefficients, np.zeros(len(second.hypothesis.directions))])
    start[:] += second.start
    return second, _shaped(problem, origin, refine(problem, both, start, origin)), True


Trial = tuple[Screened, Fitted, bool]


def _refined(problem: Problem, origin: Point, screened: list[Screened], none: Fitted, say: Say) -> list[Trial]:
    """Every effect fitted: the promising ones on the full model, the others as the linear look has them.

    Promising is what the linear look gives at least a tenth of what its best gives; a fit ends early once it cannot
    come near the best.
    """
    worst = max(one.misfit for one in screened)
    least = max(0.1 * (worst - screened[0].misfit), 0.01 * len(problem.data))
    found: list[Trial] = []
    for rank, one in enumerate(screened):
        share = one.misfit / worst
        fitted = replace(none, hypothesis=one.hypothesis, coefficients=one.start, misfit=none.misfit * share)
        closer = False
        if rank < REFINED and worst - one.misfit > least:
            say(f"{one.hypothesis.effect}, on the full model")
            rival = RIVAL * min((fit.misfit for _, fit, refined in found if refined), default=float("inf"))
            with suppress(SimulationError):
                start = best_start(problem, one.hypothesis, one.start, origin, none, expected=one.misfit)
                fitted, closer = _shaped(problem, origin, refine(problem, one.hypothesis, start, origin, rival), rival), True
        found.append((one, fitted, closer))
    return found


def _shaped(problem: Problem, origin: Point, fitted: Fitted, rival: float = float("inf")) -> Fitted:
    """The fit with what shapes its effects free as well (a frequency, a yield curvature), where more than noise is left."""
    assert fitted.hypothesis is not None
    longest = max(float(run.time[-1] - run.time[0]) for run in problem.runs)
    shapes = [shape for part in fitted.hypothesis.parts or (fitted.hypothesis,) if (shape := shape_of(part, longest))]
    if not shapes or not LEFT * len(problem.data) < fitted.misfit < rival:
        return fitted
    whole = replace(together(fitted.hypothesis, *shapes), effect=fitted.hypothesis.effect)
    freed = refine(problem, whole, np.concatenate([fitted.coefficients, np.zeros(len(shapes))]), origin, rival)
    return freed if freed.misfit < WORTH * fitted.misfit else fitted


def score(misfit: float, count: int, price: float = 0.0) -> float:
    """Score of a hypothesis: log likelihood of LOOKS independent looks whose scale is free, less its price."""
    return -0.5 * LOOKS * log(max(misfit / count, ADEQUATE)) - price


def _judged(campaign: Campaign, problem: Problem, nominal: Predictions, none: Fitted, found: list[Trial]) -> Diagnosis:
    count = len(problem.data)
    excess = max(none.misfit / count - 1.0, 0.0)
    scores = {"adequate": score(none.misfit, count), "unknown": score(count * (1.0 + UNEXPLAINED * excess), count, UNKNOWN)}
    for one, fitted, _ in found:
        scores[_name(fitted)] = score(fitted.misfit, count, price(fitted.hypothesis or one.hypothesis, one.alternatives))
    top = max(scores.values())
    weights = {name: float(np.exp(value - top)) for name, value in scores.items()}
    probabilities = {name: weight / sum(weights.values()) for name, weight in weights.items()}
    ranking = tuple(
        Candidate(fitted, scores[_name(fitted)], probabilities[_name(fitted)], closer, one.visible, _least(one, count))
        for one, fitted, closer in sorted(found, key=lambda item: -scores[_name(item[1])])
    )
    verdict, kind = _verdict(probabilities, ranking)
    return Diagnosis(campaign, problem, nominal, none, ranking, probabilities, _alike(found), verdict, kind)


def _name(fitted: Fitted) -> str:
    assert fitted.hypothesis is not None
    return fitted.hypothesis.effect


def _verdict(probabilities: dict[str, float], ranking: tuple[Candidate, ...]) -> tuple[str | None, str]:
    winner = max(probabilities, key=lambda name: probabilities[name])
    if winner in ("adequate", "unknown"):
        return None, "adequate" if winner == "adequate" else "unknown_effect"
    # Of several effects at once the first explains most.
    top = (ranking[0].hypothesis.parts or (ranking[0].hypothesis,))[0]
    return top.effect, "instrument" if top.is_instrument else "known_effect"


def _least(one: Screened, count: int) -> dict[str, float]:
    """Least size of each parameter that these data would show: a misfit raised by three tenths."""
    sizes = np.sqrt(0.3 * count) / np.maximum(np.linalg.norm(one.sideways, axis=0), 1e-300)
    return {
        key: float(size * abs(amount))
        for size, direction in zip(sizes, one.hypothesis.directions, strict=False)
        for key, amount in direction.changes.items()
        if amount
    }


def _alike(found: list[Trial]) -> tuple[tuple[str, str], ...]:
    """Pairs of effects whose traces in these data, free of the plant's, point the same way."""
    pairs = []
    for k, (a, _, _) in enumerate(found):
        for b, _, _ in found[k + 1 :]:
            if _cosine(a.sideways, b.sideways) > ALIKE:
                pairs.append((a.hypothesis.effect, b.hypothesis.effect))
    return tuple(pairs)


def _cosine(a: Floats, b: Floats) -> float:
    """Largest cosine between two spans of directions."""
    qa, qb = (np.linalg.qr(one)[0] for one in (a, b))
    return float(np.linalg.svd(qa.T @ qb, compute_uv=False)[0])


def errors(campaign: Campaign, fitted: Fitted, executor: Executor) -> tuple[float, float]:
    """Errors of a fitted point on the fit runs and on the validate runs."""
    validate = campaign.of_role("validate")
    held = gathered(validate, submit(campaign, validate, fitted.point, executor))
    return nrmse(campaign, campaign.of_role("fit"), fitted.predictions), nrmse(campaign, validate, held)
