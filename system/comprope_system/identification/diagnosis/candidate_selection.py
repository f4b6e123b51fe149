"""Which screened effects are fitted on the full model, and which of these fits are continued on the full mesh."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from comprope.errors import SimulationError

from ..estimation.gauss_newton import FitResult, gauss_newton
from ..estimation.model_score import NoiseLevel, log_score
from ..settings import CANDIDATES
from .candidate_fits import CandidateFit, FitContext, fit_on_full_model, least_chi_square, noise_level, with_mass_search
from .linear_screening import ScreenedHypothesis, indistinguishable


def fit_candidates(context: FitContext, screened: Sequence[ScreenedHypothesis]) -> list[CandidateFit]:
    """Fits of all screened effects, the promising ones on the full model.

    Screening alone does not decide: whichever effect leads is fitted on the full model until the leader is such a fit.
    """
    baseline = context.baseline
    found = [_from_screening(context, one) for one in screened]
    worthwhile = CANDIDATES.min_improvement * len(context.problem.data)
    least = max(CANDIDATES.min_share * _improvement(found[0], baseline), worthwhile)
    for k, one in enumerate(screened[: CANDIDATES.max_fits]):
        if _improvement(found[k], baseline) > least and _may_win(found[k], baseline, found):
            found[k] = fit_on_full_model(context, one, found)
    leader, gain = _leader(context, found)
    while not found[leader].refined and gain > 0.0:
        found[leader] = fit_on_full_model(context, screened[leader], found)
        leader, gain = _leader(context, found)
    if found[leader].refined:
        _fit_indistinguishable(context, screened, found, leader)
    return found


def refit_from_other_masses(
    context: FitContext, screened: Sequence[ScreenedHypothesis], found: Sequence[CandidateFit]
) -> list[CandidateFit]:
    """The candidate fits, the best one and those screened at other masses replaced by fits from there where these are better.

    `screened` are effects screened at other masses, most promising first.
    """
    fits = {one.hypothesis.effect: one for one in found}
    if (best := min((one for one in found if one.refined), key=lambda one: one.fitted.chi_square, default=None)) is not None:
        fits[best.hypothesis.effect] = with_mass_search(context, best)
    for one in screened[: CANDIDATES.max_mass_fits]:
        if one.chi_square < CANDIDATES.mass_improvement * least_chi_square(fits.values(), context.baseline.chi_square):
            fit = with_mass_search(context, fit_on_full_model(context, one, list(fits.values())))
            known = fits.setdefault(one.hypothesis.effect, fit)
            fits[one.hypothesis.effect] = min(known, fit, key=lambda other: other.fitted.chi_square)
    return list(fits.values())


@dataclass(frozen=True)
class FullMeshFits:
    """Continues candidate fits on the full mesh, each once: `known` has each fit with the one that continues it."""

    context: FitContext
    known: list[tuple[FitResult, CandidateFit]] = field(default_factory=list)

    def with_best_finished(self, found: Sequence[CandidateFit]) -> list[CandidateFit]:
        """The candidate fits, those with a chance to be the verdict on the full mesh."""
        if self.context.problem.coarse == self.context.full_problem.coarse:
            return list(found)
        noise = noise_level(self.context, found)
        top = max((one.log_score(noise) for one in found), default=0.0)
        promising = [one for one in found if one.refined and one.log_score(noise) > top - CANDIDATES.close_score]
        self.known.extend((one.fitted, self._finished(one)) for one in promising if self._continuation(one) is None)
        return [self._continuation(one) or one for one in found]

    def _continuation(self, one: CandidateFit) -> CandidateFit | None:
        """What this very fit has become on the full mesh, if it was continued."""
        return next((finished for fitted, finished in self.known if fitted is one.fitted), None)

    def _finished(self, one: CandidateFit) -> CandidateFit:
        """The candidate fit on the full mesh; unchanged where the model cannot be simulated there."""
        full, coarse = self.context.full_problem, one.fitted
        self.context.report_progress(f"{one.hypothesis.effect}: fit on the full mesh")
        try:
            fitted = gauss_newton(full, coarse.hypothesis, coarse.coefficients, self.context.origin)
        except SimulationError:
            return one
        return one._replace(fitted=fitted, problem=full)


def _fit_indistinguishable(
    context: FitContext, screened: Sequence[ScreenedHypothesis], found: list[CandidateFit], leader: int
) -> None:
    """Fit in `found` the effects with a response similar to the leader's: screening may have misjudged one of them."""
    for k, one in enumerate(screened):
        if not found[k].refined and indistinguishable(one, screened[leader]):
            found[k] = fit_on_full_model(context, one, found)


def _from_screening(context: FitContext, one: ScreenedHypothesis) -> CandidateFit:
    """Fit that screening predicts."""
    fitted = replace(
        context.baseline, hypothesis=one.hypothesis, coefficients=one.start, chi_square=one.chi_square, prior_cost=one.prior_cost
    )
    return CandidateFit(one, fitted, False, context.problem, one.chi_square)


def _improvement(one: CandidateFit, baseline: FitResult) -> float:
    """Decrease of the penalised chi-square by an effect."""
    return baseline.penalised_chi_square - one.fitted.penalised_chi_square


def _may_win(one: CandidateFit, baseline: FitResult, found: Sequence[CandidateFit]) -> bool:
    """Whether an effect that improves half as much again as screening predicts would come near the best fit so far."""
    at_best = one.fitted.penalised_chi_square - CANDIDATES.optimism * _improvement(one, baseline)
    best = min((fit.fitted.penalised_chi_square for fit in found if fit.refined), default=baseline.penalised_chi_square)
    return at_best < CANDIDATES.near_factor * best


def _leader(context: FitContext, found: Sequence[CandidateFit]) -> tuple[int, float]:
    """Number of the candidate with the highest score, and its score above that of the plant alone.

    Fits that are only predicted tell the noise as well: what is small shows in noise that is known with the effect.
    """
    baseline = context.baseline
    noise = NoiseLevel.of_fits(
        len(context.problem.data), (baseline.chi_square, *(one.fitted.chi_square for one in found))
    )
    leader = max(range(len(found)), key=lambda k: found[k].log_score(noise))
    return leader, found[leader].log_score(noise) - log_score(baseline.chi_square, noise, baseline.prior_cost)
