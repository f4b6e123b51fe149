"""Diagnosis: which physical effect is missing from the model of a campaign.

Linear screening about the fitted plant predicts the size of every effect and the chi-square that it would leave, with the
plant's parameters refitted; the most promising effects are then fitted on the full model and ranked by their scores.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..data.campaign import Campaign
from ..estimation.coarse_to_fine import fit_from_file, problem_of_fits
from ..estimation.gauss_newton import FitResult
from ..estimation.model_score import NoiseLevel, complexity_penalty, least_noticed, log_score
from ..estimation.weighted_least_squares import LeastSquaresProblem, build_problem
from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.parameter_point import ParameterPoint, Predictions, collect_predictions, submit_replays
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..progress import ProgressCallback, no_progress
from ..settings import CANDIDATES, SCORE, SCREENING, VERDICT
from .candidate_fits import CandidateFit, FitContext, least_chi_square, noise_level
from .candidate_selection import FullMeshFits, fit_candidates, refit_from_other_masses
from .linear_screening import ScreenedHypothesis, indistinguishable, screen_at_other_masses, screen_hypotheses
from .pair_fits import fit_pair, with_single_fits
from .size_screening import screen_at_sizes, with_sizes

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Candidate:
    """Effect in the ranking.

    `refined`: fitted on the full model, not only screened. `distinct_share` is the share of the effect's response that the
    plant's parameters cannot imitate; `detection_limits` are the least sizes of its parameters that these data would show, by
    model key.
    """

    fitted: FitResult
    log_score: float
    probability: float
    refined: bool
    distinct_share: float
    detection_limits: dict[str, float]

    @property
    def hypothesis(self) -> Hypothesis:
        """Hypothesis that was fitted."""
        assert self.fitted.hypothesis is not None
        return self.fitted.hypothesis


@dataclass(frozen=True)
class Diagnosis:
    """Outcome of a diagnosis.

    `nominal` are the predictions of the model file, `baseline` is the fit of the plant alone; `probabilities` are those of the
    effects, of "adequate" and of "unknown"; `verdict` is an effect or None, `kind` that of the verdict as in the JSON result.
    """

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
    """Rank all effects as explanations of the fit runs of a campaign, except those in `without`.

    `base` has the effects that are in the model already, and plant coefficients of an earlier fit to begin with.
    """
    origin = base or ParameterPoint()
    runs = campaign.of_role("fit")
    report_progress("model as in the file")
    nominal = collect_predictions(runs, submit_replays(campaign, runs, origin, executor))
    problem = replace(build_problem(campaign, runs, executor, nominal), ruled_out=frozenset(without))
    report_progress("plant parameters")
    start = np.array([origin.plant.get(one.name, 0.0) for one in PLANT_PARAMETERS])
    rough, on_coarse_mesh, baseline = fit_from_file(
        problem, None, start, origin, nominal, search_mass=not start.any()
    )
    initial_fit = replace(on_coarse_mesh, predictions=nominal)
    context = FitContext(problem, problem_of_fits(problem, rough, baseline), origin, baseline, report_progress)
    of_changes = problem if context.problem is problem else problem.on_coarse_mesh()
    report_progress("linear screening of all effects")
    screened = screen_hypotheses(of_changes, origin, baseline, initial_fit)
    if baseline.chi_square > CANDIDATES.explained * len(problem.data):
        report_progress("screening at several sizes of each effect")
        close = baseline.chi_square < SCREENING.close_fit * len(problem.data)
        about = (baseline,) if close else (baseline, initial_fit)
        screened = with_sizes(screened, screen_at_sizes(of_changes, origin, about))
    found = fit_candidates(context, screened)
    full_mesh_fits = FullMeshFits(context)
    finished = full_mesh_fits.with_best_finished(found)
    if least_chi_square(finished, baseline.chi_square) > CANDIDATES.mass_threshold * len(problem.data):
        report_progress("linear screening at other masses of the rope")
        found = refit_from_other_masses(context, screen_at_other_masses(rough, origin, on_coarse_mesh), found)
        finished = full_mesh_fits.with_best_finished(found)
    diagnosis = _assembled(context, campaign, nominal, finished)
    if diagnosis.kind == "unknown_effect" and (pair := fit_pair(context, found)):
        found = with_single_fits(context, found, pair)
        return _assembled(context, campaign, nominal, full_mesh_fits.with_best_finished(found))
    return diagnosis


def _assembled(
    context: FitContext, campaign: Campaign, nominal: Predictions, found: Sequence[CandidateFit]
) -> Diagnosis:
    """Diagnosis from candidate fits: probabilities in proportion to the exponential of the scores."""
    baseline, noise = context.baseline, noise_level(context, found)
    scores = {"adequate": log_score(baseline.chi_square, noise, baseline.prior_cost)}
    scores |= {one.hypothesis.effect: one.log_score(noise) for one in found}
    scores["unknown"] = _unknown_score(baseline, found, noise)
    top = max(scores.values())
    weights = {name: float(np.exp(value - top)) for name, value in scores.items()}
    probabilities = {name: weight / sum(weights.values()) for name, weight in weights.items()}
    best_first = sorted(found, key=lambda one: -scores[one.hypothesis.effect])
    least = least_chi_square(found, baseline.chi_square)
    ranking = tuple(_candidate(one, scores, probabilities, _detection_limits(one.screening, least, noise)) for one in best_first)
    verdict, kind = _verdict(probabilities, ranking)
    alike = _indistinguishable_pairs(found)
    return Diagnosis(campaign, context.full_problem, nominal, baseline, ranking, probabilities, alike, verdict, kind)


def _unknown_score(baseline: FitResult, found: Sequence[CandidateFit], noise: NoiseLevel) -> float:
    """Score of an effect outside the library.

    It is assumed to leave about as much as the best known effect that explains anything, at least `VERDICT.unknown_share` of the
    excess of chi-square, and to have the prior cost of the same fit. All that is a guess, so that it is compared with that fit,
    or with the plant's, by the ratio of their chi-squares only.
    """
    left, best = 1.0, baseline
    known = max(found, key=lambda one: one.log_score(noise), default=None)
    if known and known.log_score(noise) > log_score(baseline.chi_square, noise, baseline.prior_cost):
        best = known.fitted
        left = min(best.chi_square / noise.count, VERDICT.unknown_chi_square)
    left = max(left, 1.0 + VERDICT.unknown_share * max(baseline.chi_square / noise.count - 1.0, 0.0))
    gain = 0.5 * SCORE.effective_samples * np.log(best.chi_square / noise.count / left)
    penalty = VERDICT.unknown_penalty + min(best.prior_cost, VERDICT.unknown_prior_cost)
    return log_score(best.chi_square, noise, penalty) + float(gain)


def _candidate(
    one: CandidateFit, scores: dict[str, float], probabilities: dict[str, float], limits: dict[str, float]
) -> Candidate:
    """Entry of the ranking."""
    name = one.hypothesis.effect
    return Candidate(one.fitted, scores[name], probabilities[name], one.refined, one.screening.distinct_share, limits)


def _verdict(probabilities: dict[str, float], ranking: tuple[Candidate, ...]) -> tuple[str | None, str]:
    """Effect of the highest probability, None for adequate and unknown, and the kind of the verdict."""
    winner = max(probabilities, key=lambda name: probabilities[name])
    if winner in ("adequate", "unknown"):
        return None, "adequate" if winner == "adequate" else "unknown_effect"
    # A combination of effects begins with the one that explains most.
    top = (ranking[0].hypothesis.parts or (ranking[0].hypothesis,))[0]
    return top.effect, "instrument" if top.is_instrument else "known_effect"


def _detection_limits(one: ScreenedHypothesis, chi_square: float, noise: NoiseLevel) -> dict[str, float]:
    """Least size of each parameter, by model key, with which the effect would be the verdict, given what the best fit leaves."""
    cost = complexity_penalty(one.hypothesis, one.alternatives) + VERDICT.detection_margin
    least = least_noticed(chi_square, noise, cost)
    sizes = np.sqrt(least) / np.maximum(np.linalg.norm(one.orthogonal_part, axis=0), 1e-300)
    return {
        key: float(size * abs(amount))
        for size, direction in zip(sizes, one.hypothesis.directions, strict=False)
        for key, amount in direction.changes.items()
        if amount
    }


def _indistinguishable_pairs(found: Sequence[CandidateFit]) -> tuple[tuple[str, str], ...]:
    """Pairs of effects whose responses, with the plant projected out, are nearly parallel."""
    pairs = []
    responses = [one.screening for one in found]
    for k, a in enumerate(responses):
        for b in responses[k + 1 :]:
            if indistinguishable(a, b):
                pairs.append((a.hypothesis.effect, b.hypothesis.effect))
    return tuple(pairs)
