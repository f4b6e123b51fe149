"""Which physical effect is missing: rank all hypotheses about a campaign and say what can be said.

One linearisation about the model file gives every effect's expected size and what it would explain,
plant parameters refitted beside it. The most promising are then refined on the full model. Scores
compare misfits as ratios, as if LOOKS independent looks had been taken: the discrepancy of a model is
one and the same in thousands of samples, which a plain likelihood would count as evidence each.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from math import log

import numpy as np
from numpy.typing import NDArray

from .campaign import Campaign
from .errors_of import nrmse
from .fit import Fitted, refine
from .hypotheses import NUISANCES, Direction, Hypothesis, hypotheses, of_instruments, together
from .linear import by_effect, by_plant, unit_points
from .point import Point, Predictions, gathered, submit
from .problem import Problem, pose, solve
from .spectrum import frequencies

Floats = NDArray[np.float64]
Say = Callable[[str], None]

LOOKS = 40.0  # independent looks that a campaign is worth
PRICE = 1.5  # of the score, for each parameter of an effect
UNEXPLAINED = 0.04  # of the misfit that is too much: what "none of the known effects" stands for
ADEQUATE = 0.95  # misfit per datum below which there is nothing to explain
REFINED = 4  # hypotheses that are refined on the full model
SECOND = 0.7  # of the misfit that the best effect may leave if a second one is to be looked for
PAIRS = 2  # second effects that are refined with the first
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
    plant = by_plant(problem, origin, problem.whitened(nominal))
    none = refine(problem, None, np.zeros(len(NUISANCES)), origin, plant)
    say("every effect, linearised")
    screened = _screen(problem, campaign, origin, nominal, plant, none)
    found = _refined(problem, origin, screened, plant, none, say)
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
    plant = by_plant(problem, first.point, problem.whitened(first.predictions))
    own = by_effect(
        problem, first.hypothesis, replace(origin, plant=first.point.plant), first.effect_coefficients, first.predictions
    )
    screened = _screen(problem, judged.campaign, first.point, first.predictions, np.hstack([plant, own]), first)
    pairs = [_pair(problem, origin, first, one, plant, say) for one in screened[:PAIRS]]
    return _judged(judged.campaign, problem, judged.nominal, judged.none, [*found, min(pairs, key=lambda one: one[1].misfit)])


def _pair(problem: Problem, origin: Point, first: Fitted, second: "Screened", plant: Floats, say: Say) -> "Trial":
    """Both effects refined together on the full model."""
    assert first.hypothesis is not None
    both = together(first.hypothesis, second.hypothesis)
    say(f"{both.effect}, on the full model")
    start = np.concatenate([first.coefficients, np.zeros(len(second.hypothesis.directions))])
    start[:] += second.start
    fitted = refine(problem, both, start, origin, plant)
    return replace(second, hypothesis=both), fitted, True


@dataclass(frozen=True)
class Screened:
    """A hypothesis after the linear look: start of its refinement, predicted misfit, its direction free of the plant's."""

    hypothesis: Hypothesis
    start: Floats
    misfit: float
    sideways: Floats
    visible: float
    alternatives: int


Trial = tuple[Screened, Fitted, bool]


def _screen(
    problem: Problem, campaign: Campaign, origin: Point, nominal: Predictions, plant: Floats, none: Fitted
) -> list[Screened]:
    """Every effect's best alternative, most promising first."""
    y = problem.whitened(nominal)
    found = hypotheses(frequencies(problem, none.predictions))
    columns = _effect_columns(problem, origin, nominal, y, found) | _instrument_columns(
        problem, nominal, of_instruments(campaign.channels)
    )
    present = {key.split(".")[1] for key in origin.effects}
    looks = [_look(problem, one, y, plant, by, columns) for one, by in columns.items() if one.effect not in present]
    best: dict[str, Screened] = {}
    for one in sorted(looks, key=lambda look: look.misfit):
        best.setdefault(one.hypothesis.effect, one)
    return list(best.values())


def _effect_columns(
    problem: Problem, origin: Point, nominal: Predictions, y: Floats, found: Sequence[Hypothesis]
) -> dict[Hypothesis, Floats]:
    """Derivatives (N, directions) of every hypothesis, all replays side by side."""
    points = [point for one in found for point in unit_points(origin, one)]
    moved = iter(problem.predictions(*points))
    return {one: np.column_stack([problem.whitened(next(moved)) - y for _ in one.directions]) for one in found}


def _instrument_columns(problem: Problem, nominal: Predictions, found: Sequence[Hypothesis]) -> dict[Hypothesis, Floats]:
    return {one: by_effect(problem, one, Point(), [0.0], nominal) for one in found}


def _look(problem: Problem, one: Hypothesis, y: Floats, plant: Floats, by: Floats, among: dict[Hypothesis, Floats]) -> Screened:
    # Columns beyond the plant's belong to effects that are there already.
    beside = [*NUISANCES, *(Direction("present", {}, 3.0) for _ in range(plant.shape[1] - len(NUISANCES)))]
    solution = solve(problem.data - y, np.hstack([plant, by]), [*beside, *one.directions])
    weights = np.vstack([plant, np.diag([1.0 / p.prior for p in beside])])
    padded = np.vstack([by, np.zeros((len(beside), by.shape[1]))])
    sideways = padded - weights @ np.linalg.lstsq(weights, padded, rcond=None)[0]
    visible = float(np.linalg.norm(sideways)) / max(float(np.linalg.norm(by)), 1e-300)
    same = sum(other.effect == one.effect for other in among)
    return Screened(one, solution.coefficients, solution.misfit, sideways[: len(by)], visible, same)


def _refined(problem: Problem, origin: Point, screened: list[Screened], plant: Floats, none: Fitted, say: Say) -> list[Trial]:
    """Every effect fitted: the promising ones on the full model, the others as the linear look has them.

    Promising is what the linear look gives at least a tenth of what its best gives.
    """
    worst = max(one.misfit for one in screened)
    best_gain = worst - screened[0].misfit
    found = []
    for rank, one in enumerate(screened):
        closer = rank < REFINED and worst - one.misfit > max(0.1 * best_gain, 0.01 * len(problem.data))
        if closer:
            say(f"{one.hypothesis.effect}, on the full model")
            fitted = refine(problem, one.hypothesis, one.start, origin, plant)
        else:
            share = one.misfit / worst
            fitted = replace(
                none, hypothesis=one.hypothesis, coefficients=one.start, misfit=none.misfit * share, cost=none.cost * share
            )
        found.append((one, fitted, closer))
    return found


def score(misfit: float, count: int, price: float = 0.0) -> float:
    """Score of a hypothesis: log likelihood of LOOKS independent looks whose scale is free, less its price."""
    return -0.5 * LOOKS * log(max(misfit / count, ADEQUATE)) - price


def _judged(campaign: Campaign, problem: Problem, nominal: Predictions, none: Fitted, found: list[Trial]) -> Diagnosis:
    count = len(problem.data)
    excess = max(none.misfit / count - 1.0, 0.0)
    scores = {"adequate": score(none.misfit, count), "unknown": score(count * (1.0 + UNEXPLAINED * excess), count, 6.0)}
    for one, fitted, _ in found:
        price = PRICE * (1 + len(one.hypothesis.directions)) + log(one.alternatives)
        scores[one.hypothesis.effect] = score(fitted.misfit, count, price)
    top = max(scores.values())
    weights = {name: float(np.exp(value - top)) for name, value in scores.items()}
    probabilities = {name: weight / sum(weights.values()) for name, weight in weights.items()}
    ranking = tuple(
        Candidate(
            fitted, scores[one.hypothesis.effect], probabilities[one.hypothesis.effect], closer, one.visible, _least(one, count)
        )
        for one, fitted, closer in sorted(found, key=lambda item: -scores[item[0].hypothesis.effect])
    )
    verdict, kind = _verdict(probabilities, ranking)
    return Diagnosis(campaign, problem, nominal, none, ranking, probabilities, _alike(found), verdict, kind)


def _verdict(probabilities: dict[str, float], ranking: tuple[Candidate, ...]) -> tuple[str | None, str]:
    winner = max(probabilities, key=lambda name: probabilities[name])
    if winner in ("adequate", "unknown"):
        return None, "adequate" if winner == "adequate" else "unknown_effect"
    # Of several effects at once the first explains most.
    top = (ranking[0].hypothesis.parts or (ranking[0].hypothesis,))[0]
    return top.effect, "instrument" if top.is_instrument else "known_effect"


def _least(one: Screened, count: int) -> dict[str, float]:
    """Least size of each parameter that these data would show: a misfit raised by three tenths.

    Of a pair of effects, only the second's traces were looked at here.
    """
    sizes = np.sqrt(0.3 * count) / np.maximum(np.linalg.norm(one.sideways, axis=0), 1e-300)
    return {
        key: float(size * abs(amount))
        for size, direction in zip(sizes, one.hypothesis.directions[-len(sizes) :], strict=True)
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
