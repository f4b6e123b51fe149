"""Which physical effect is missing: rank all hypotheses about a campaign and say what can be said.

One linearisation about the model file gives every effect's expected size and what it would explain,
plant parameters refitted beside it. The most promising are then refined on the full model.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..data.campaign import Campaign
from ..estimation.gauss_newton import Fitted, evaluate
from ..estimation.mass_search import refitted
from ..estimation.model_score import score
from ..estimation.weighted_least_squares import Problem, pose
from ..hypotheses.effect_hypotheses import Hypothesis
from ..hypotheses.plant_parameters import NUISANCES
from ..prediction.parameter_point import Point, Predictions, gathered, submit
from .candidate_fits import Say, Trial, challenged, least_misfit, rivals, second_look
from .linear_screening import Screened, alike, screen, seen_from_elsewhere

Floats = NDArray[np.float64]

UNEXPLAINED = 0.04  # of the misfit that is too much: what "none of the known effects" stands for
UNKNOWN = 10.0  # its price
COMMON = 1.06  # misfit per datum that a model with the right effect may leave
USUAL = 5.0  # strain of a plant whose data sheets are as good as usual
MUCH = 2.0  # misfit per datum of the best fit above which effects are looked at from other masses as well


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


def diagnose(
    campaign: Campaign, executor: Executor, say: Say = lambda _: None, base: Point | None = None, without: Sequence[str] = ()
) -> Diagnosis:
    """Rank all effects against a campaign, `without` some; `base` has effects that are in the model already."""
    origin = base or Point()
    runs = campaign.of_role("fit")
    say("the model as it is")
    nominal = gathered(runs, submit(campaign, runs, origin, executor))
    problem = replace(pose(campaign, runs, executor, nominal), ruled_out=frozenset(without))
    say("plant parameters")
    begun = evaluate(problem, None, np.zeros(len(NUISANCES)), origin)
    none = refitted(problem, begun, origin)
    say("every effect, linearised")
    found = rivals(problem, origin, screen(problem, origin, none, begun), none, say)
    if least_misfit(found, none) > MUCH * len(problem.data):
        say("every effect, from other masses of the rope")
        found = challenged(problem, origin, seen_from_elsewhere(problem, origin, begun), none, found, say)
    judged = _judged(campaign, problem, nominal, none, found)
    if judged.kind == "unknown_effect" and (pair := second_look(problem, origin, found, none, say)):
        return _judged(campaign, problem, nominal, none, [*found, pair])
    return judged


def _judged(campaign: Campaign, problem: Problem, nominal: Predictions, none: Fitted, found: list[Trial]) -> Diagnosis:
    count = len(problem.data)
    scores = {"adequate": score(none.misfit, count, none.strain)}
    scores |= {one.hypothesis.effect: one.score(count) for one in found}
    scores["unknown"] = _unknown(none, found, count)
    top = max(scores.values())
    weights = {name: float(np.exp(value - top)) for name, value in scores.items()}
    probabilities = {name: weight / sum(weights.values()) for name, weight in weights.items()}
    ranking = tuple(
        _candidate(one, scores, probabilities, count) for one in sorted(found, key=lambda one: -scores[one.hypothesis.effect])
    )
    verdict, kind = _verdict(probabilities, ranking)
    return Diagnosis(campaign, problem, nominal, none, ranking, probabilities, _alike(found), verdict, kind)


def _unknown(none: Fitted, found: list[Trial], count: int) -> float:
    """Score of an effect that nobody knows, which would leave about as much as one that is known and explains something."""
    left, bent = 1.0, none.strain
    known = max(found, key=lambda one: one.score(count), default=None)
    if known and known.score(count) > score(none.misfit, count, none.strain):
        left, bent = min(known.fitted.misfit / count, COMMON), known.fitted.strain
    excess = max(none.misfit / count - 1.0, 0.0)
    return score(count * max(left, 1.0 + UNEXPLAINED * excess), count, UNKNOWN + min(bent, USUAL))


def _candidate(one: Trial, scores: dict[str, float], probabilities: dict[str, float], count: int) -> Candidate:
    name = one.hypothesis.effect
    return Candidate(one.fitted, scores[name], probabilities[name], one.refined, one.seen.visible, _least(one.seen, count))


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
    traces = [one.seen for one in found]
    for k, a in enumerate(traces):
        for b in traces[k + 1 :]:
            if alike(a, b):
                pairs.append((a.hypothesis.effect, b.hypothesis.effect))
    return tuple(pairs)
