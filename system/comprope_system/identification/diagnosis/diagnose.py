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
from ..estimation.gauss_newton import FitResult, evaluate
from ..estimation.mass_search import fit_with_mass_search
from ..estimation.model_score import log_score
from ..estimation.weighted_least_squares import LeastSquaresProblem, build_problem
from ..hypotheses.effect_hypotheses import Hypothesis
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint, Predictions, collect_predictions, submit_replays
from ..progress import ProgressCallback, no_progress
from ..settings import CANDIDATES, VERDICT
from .candidate_fits import CandidateFit, fit_candidates, fit_pair, least_chi_square, refit_from_other_masses
from .linear_screening import ScreenedHypothesis, indistinguishable, screen_at_other_masses, screen_hypotheses

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Candidate:
    """One effect in the ranking."""

    fitted: FitResult
    log_score: float
    probability: float
    refined: bool
    distinct_share: float
    detection_limits: dict[str, float]

    @property
    def hypothesis(self) -> Hypothesis:
        """What the effect does."""
        assert self.fitted.hypothesis is not None
        return self.fitted.hypothesis


@dataclass(frozen=True)
class Diagnosis:
    """The outcome: `none` is the refitted model without a new effect; probabilities include "adequate" and "unknown"."""

    campaign: Campaign
    problem: LeastSquaresProblem
    nominal: Predictions
    baseline: FitResult
    ranking: tuple[Candidate, ...]
    probabilities: dict[str, float]
    indistinguishable: tuple[tuple[str, str], ...]
    verdict: str | None
    kind: str


def diagnose(
    campaign: Campaign,
    executor: Executor,
    report_progress: ProgressCallback = no_progress,
    base: ParameterPoint | None = None,
    without: Sequence[str] = (),
) -> Diagnosis:
    """Rank all effects against a campaign, `without` some; `base` has effects that are in the model already."""
    origin = base or ParameterPoint()
    runs = campaign.of_role("fit")
    report_progress("the model as it is")
    nominal = collect_predictions(runs, submit_replays(campaign, runs, origin, executor))
    problem = replace(build_problem(campaign, runs, executor, nominal), ruled_out=frozenset(without))
    report_progress("plant parameters")
    initial_fit = evaluate(problem, None, np.zeros(len(PLANT_PARAMETERS)), origin)
    baseline = fit_with_mass_search(problem, initial_fit, origin)
    report_progress("every effect, linearised")
    found = fit_candidates(problem, origin, screen_hypotheses(problem, origin, baseline, initial_fit), baseline, report_progress)
    if least_chi_square(found, baseline) > CANDIDATES.mass_threshold * len(problem.data):
        report_progress("every effect, from other masses of the rope")
        found = refit_from_other_masses(
            problem, origin, screen_at_other_masses(problem, origin, initial_fit), baseline, found, report_progress
        )
    diagnosis = _assembled(campaign, problem, nominal, baseline, found)
    if diagnosis.kind == "unknown_effect" and (pair := fit_pair(problem, origin, found, baseline, report_progress)):
        return _assembled(campaign, problem, nominal, baseline, [*found, pair])
    return diagnosis


def _assembled(
    campaign: Campaign, problem: LeastSquaresProblem, nominal: Predictions, baseline: FitResult, found: list[CandidateFit]
) -> Diagnosis:
    count = len(problem.data)
    scores = {"adequate": log_score(baseline.chi_square, count, baseline.prior_cost)}
    scores |= {one.hypothesis.effect: one.log_score(count) for one in found}
    scores["unknown"] = _unknown(baseline, found, count)
    top = max(scores.values())
    weights = {name: float(np.exp(value - top)) for name, value in scores.items()}
    probabilities = {name: weight / sum(weights.values()) for name, weight in weights.items()}
    ranking = tuple(
        _candidate(one, scores, probabilities, count) for one in sorted(found, key=lambda one: -scores[one.hypothesis.effect])
    )
    verdict, kind = _verdict(probabilities, ranking)
    return Diagnosis(campaign, problem, nominal, baseline, ranking, probabilities, _indistinguishable_pairs(found), verdict, kind)


def _unknown(baseline: FitResult, found: list[CandidateFit], count: int) -> float:
    """Score of an effect that nobody knows, which would leave about as much as one that is known and explains something."""
    left, bent = 1.0, baseline.prior_cost
    known = max(found, key=lambda one: one.log_score(count), default=None)
    if known and known.log_score(count) > log_score(baseline.chi_square, count, baseline.prior_cost):
        left, bent = min(known.fitted.chi_square / count, VERDICT.unknown_chi_square), known.fitted.prior_cost
    excess = max(baseline.chi_square / count - 1.0, 0.0)
    return log_score(
        count * max(left, 1.0 + VERDICT.unknown_share * excess),
        count,
        VERDICT.unknown_penalty + min(bent, VERDICT.unknown_prior_cost),
    )


def _candidate(one: CandidateFit, scores: dict[str, float], probabilities: dict[str, float], count: int) -> Candidate:
    name = one.hypothesis.effect
    return Candidate(
        one.fitted, scores[name], probabilities[name], one.refined, one.screening.distinct_share, _least(one.screening, count)
    )


def _verdict(probabilities: dict[str, float], ranking: tuple[Candidate, ...]) -> tuple[str | None, str]:
    winner = max(probabilities, key=lambda name: probabilities[name])
    if winner in ("adequate", "unknown"):
        return None, "adequate" if winner == "adequate" else "unknown_effect"
    # Of several effects at once the first explains most.
    top = (ranking[0].hypothesis.parts or (ranking[0].hypothesis,))[0]
    return top.effect, "instrument" if top.is_instrument else "known_effect"


def _least(one: ScreenedHypothesis, count: int) -> dict[str, float]:
    """Least size of each parameter that these data would show: a misfit raised by three tenths."""
    sizes = np.sqrt(VERDICT.detection_increase * count) / np.maximum(np.linalg.norm(one.orthogonal_part, axis=0), 1e-300)
    return {
        key: float(size * abs(amount))
        for size, direction in zip(sizes, one.hypothesis.directions, strict=False)
        for key, amount in direction.changes.items()
        if amount
    }


def _indistinguishable_pairs(found: list[CandidateFit]) -> tuple[tuple[str, str], ...]:
    """Pairs of effects whose traces in these data, free of the plant's, point the same way."""
    pairs = []
    traces = [one.screening for one in found]
    for k, a in enumerate(traces):
        for b in traces[k + 1 :]:
            if indistinguishable(a, b):
                pairs.append((a.hypothesis.effect, b.hypothesis.effect))
    return tuple(pairs)
