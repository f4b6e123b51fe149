"""Linear screening: what each hypothesis would explain beside the plant's parameters, predicted from derivatives.

With the jacobian J of the plant (prior weights appended), the response S of an effect and the residual r, the coefficients of
both are found by one linear least-squares solution; the part of S orthogonal to J, S - J J^+ S, tells effects apart.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..estimation.effect_responses import effect_responses
from ..estimation.gauss_newton import FitResult
from ..estimation.linearisation import instrument_jacobian, point_at
from ..estimation.mass_search import MASS, fits_at_masses
from ..estimation.model_score import complexity_penalty, penalised_chi_square
from ..estimation.per_run_phase import solve_per_run_phases
from ..estimation.weighted_least_squares import LeastSquaresProblem, solve_in_scale
from ..prediction.effect_hypotheses import Hypothesis, effect_hypotheses, instrument_hypotheses
from ..prediction.parameter_point import ParameterPoint
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..prediction.replay import coarsening_factor
from ..settings import SCREENING
from .frequency_candidates import residual_peak_frequencies, sway_frequencies

Floats = NDArray[np.float64]
Responses = Mapping[Hypothesis, Floats]


@dataclass(frozen=True)
class ScreenedHypothesis:
    """Hypothesis with its linear prediction: coefficients `start` (k,), plant first, the chi-square that it would leave, and the
    cost of the plant's coefficients in the score.

    `orthogonal_part` (N, directions) is its response with the plant's projected out, `distinct_share` the norm of that over
    the norm of the response; `alternatives` is the number of variants of the effect that were screened. `sized`: the effect was
    simulated at about the size of its coefficients.
    """

    hypothesis: Hypothesis
    start: Floats
    chi_square: float
    prior_cost: float
    orthogonal_part: Floats
    distinct_share: float
    alternatives: int
    sized: bool = False

    @property
    def penalised_chi_square(self) -> float:
        """Chi-square with complexity penalty and prior cost included."""
        return penalised_chi_square(self.chi_square, complexity_penalty(self.hypothesis, self.alternatives) + self.prior_cost)

    @cached_property
    def basis(self) -> Floats:
        """Orthonormal basis (N, directions) of the orthogonal part."""
        return np.asarray(np.linalg.qr(self.orthogonal_part)[0])


def indistinguishable(a: ScreenedHypothesis, b: ScreenedHypothesis) -> bool:
    """Whether two effects have nearly the same response: largest cosine between their orthogonal parts."""
    return bool(np.linalg.svd(a.basis.T @ b.basis, compute_uv=False)[0] > SCREENING.indistinguishable)


def screen_hypotheses(
    problem: LeastSquaresProblem,
    origin: ParameterPoint,
    baseline: FitResult,
    nominal: FitResult | None = None,
    tried: tuple[float, ...] | None = None,
) -> list[ScreenedHypothesis]:
    """Best variant of every effect, most promising effect first; effects that `origin` has or that are ruled out are left out.

    Residual and derivatives of the plant are those of the fit `baseline` and, where it leaves much, also those of `nominal`:
    a fit without the missing effect has a distorted plant. `tried` are frequencies [Hz] of oscillating effects; by default
    `promising_frequencies`.
    """
    left_out = {key.split(".")[1] for key in origin.effects} | problem.ruled_out
    known = effect_hypotheses(problem.campaign.model, promising_frequencies(problem, baseline) if tried is None else tried)
    tried_here = [one for one in [*known, *instrument_hypotheses(problem.campaign.channels)] if one.effect not in left_out]
    responses = effect_responses(problem, origin, [one for one in tried_here if not one.follows_from_predictions])
    at = baseline.predictions
    responses |= {one: instrument_jacobian(problem, one, origin, at) for one in tried_here if one.follows_from_predictions}
    return best_per_effect(screen_about_fits(problem, responses, baseline, nominal))


def best_per_effect(screened: Sequence[ScreenedHypothesis]) -> list[ScreenedHypothesis]:
    """Best variant of every effect, most promising effect first, with the number of variants that the effect had."""
    best: dict[str, ScreenedHypothesis] = {}
    for one in sorted(screened, key=lambda one: one.penalised_chi_square):
        best.setdefault(one.hypothesis.effect, one)
    return list(best.values())


def promising_frequencies(problem: LeastSquaresProblem, fitted: FitResult) -> tuple[float, ...]:
    """Frequencies [Hz] to screen for oscillating effects: those at which a sway explains most, and peaks of the residual."""
    sway = sway_frequencies(problem, fitted, coarsening_factor(problem.campaign.model))
    return tuple(dict.fromkeys([*sway, *residual_peak_frequencies(problem, fitted.predictions)]))


def screen_about_fits(
    problem: LeastSquaresProblem, responses: Responses, baseline: FitResult, nominal: FitResult | None
) -> list[ScreenedHypothesis]:
    """All variants with responses (N, directions), screened about `baseline` and, where that leaves much, about `nominal`.

    A chi-square predicted about `nominal` is scaled by that of `baseline` over the one predicted for the plant alone.
    """
    screened: list[ScreenedHypothesis] = []
    close = nominal is None or baseline.chi_square < SCREENING.close_fit * len(problem.data)
    for fit in [baseline] if nominal is None or close else [baseline, nominal]:
        residual, directions = problem.residual(fit.predictions), problem.directions(fit.hypothesis)
        plant = solve_in_scale(residual, fit.jacobian, directions, fit.coefficients)
        share, imitable = baseline.chi_square / plant.chi_square, imitable_responses(problem, fit)
        for one in responses:
            screened += _screened_variants(problem, one, responses, fit, imitable, share)
    return screened


def screen_at_other_masses(
    problem: LeastSquaresProblem, origin: ParameterPoint, initial_fit: FitResult
) -> list[ScreenedHypothesis]:
    """Best variant of every effect, screened at other masses of the rope, most promising first.

    A large effect makes the rope oscillate, with another period where the model's mass is wrong: the response there does not
    resemble the residual, and the fit without the effect does not reveal the mass either. `initial_fit` has the plant's
    derivatives at its stated values.
    """
    screened: list[ScreenedHypothesis] = []
    for x, predictions, solution in fits_at_masses(problem, initial_fit, origin, SCREENING.masses):
        point = point_at(initial_fit.hypothesis, list(x), origin)
        fit = replace(initial_fit, coefficients=x, point=point, predictions=predictions, chi_square=solution.chi_square)
        mass = {PLANT_PARAMETERS[MASS].name: float(x[MASS])}
        at_mass = replace(origin, plant=dict(origin.plant) | mass)
        # A forced oscillation has the frequency of the excitation at any mass.
        screened += screen_hypotheses(problem, at_mass, fit, tried=residual_peak_frequencies(problem, predictions))
    return best_per_effect(screened)


def _screened_variants(
    problem: LeastSquaresProblem, one: Hypothesis, responses: Responses, fit: FitResult, imitable: Floats, share: float
) -> Iterator[ScreenedHypothesis]:
    """Hypothesis with the same phase in all runs and, if it has a phase, with one for each run, screened about a fit.

    `imitable` are the responses that the fit's parameters imitate; chi-squares are multiplied by `share`.
    """
    response = responses[one]
    variants = sum(other.effect == one.effect for other in responses)
    orthogonal, distinct = orthogonal_response(response, imitable)
    start = np.concatenate([fit.coefficients, np.zeros(response.shape[1])])
    matrix, directions = np.hstack([fit.jacobian, response]), [*problem.directions(fit.hypothesis), *one.directions]
    solution = solve_in_scale(problem.residual(fit.predictions), matrix, directions, start)
    cost = problem.prior_cost(solution.coefficients)
    yield ScreenedHypothesis(one, solution.coefficients, share * solution.chi_square, cost, orthogonal, distinct, variants)
    if one.polar and len(problem.runs) > 1:
        with_phases, found, chi_square = solve_per_run_phases(problem, fit, response, one)
        cost = problem.prior_cost(found)
        yield ScreenedHypothesis(with_phases, found, share * chi_square, cost, orthogonal, distinct, 2 * variants)


def imitable_responses(problem: LeastSquaresProblem, fit: FitResult) -> Floats:
    """Orthonormal basis (N + parameters, parameters) of what the parameters of a fit can imitate within their priors."""
    priors = np.diag([1.0 / one.prior for one in problem.directions(fit.hypothesis)])
    return np.asarray(np.linalg.qr(np.vstack([fit.jacobian, priors]))[0])


def orthogonal_response(response: Floats, imitable: Floats) -> tuple[Floats, float]:
    """Part of a response (N, k) that the parameters of a fit cannot imitate, and its share of the norm."""
    count = len(response)
    orthogonal = response - imitable[:count] @ (imitable[:count].T @ response)
    return orthogonal, float(np.linalg.norm(orthogonal)) / max(float(np.linalg.norm(response)), 1e-300)
