"""Fits of two effects together, and the check that both are needed."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from comprope.errors import SimulationError

from ..estimation.gauss_newton import FitResult, gauss_newton
from ..prediction.effect_hypotheses import Hypothesis, combine
from ..prediction.model_effects import components_by_effect, effect_name
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..settings import CANDIDATES
from .candidate_fits import CandidateFit, FitContext, corrected_by_full_mesh, with_mass_search
from .linear_screening import ScreenedHypothesis, screen_hypotheses


def fit_pair(context: FitContext, found: Sequence[CandidateFit]) -> CandidateFit | None:
    """Best effect and a second one fitted together; None where the best alone explains too little."""
    first = min((one for one in found if one.refined), key=lambda one: one.fitted.chi_square, default=None)
    if first is None or first.fitted.chi_square > CANDIDATES.pair_threshold * context.baseline.chi_square:
        return None
    context.report_progress(f"{first.hypothesis.effect} and a second effect: linear screening")
    screened = screen_hypotheses(first.problem, first.fitted.point, first.fitted)
    pairs = [pair for one in screened[: CANDIDATES.max_pairs] if (pair := _fit_together(context, first, one))]
    best = min(pairs, key=lambda one: one.fitted.chi_square, default=None)
    return best and with_mass_search(context, best)


def _fit_together(context: FitContext, first: CandidateFit, second: ScreenedHypothesis) -> CandidateFit | None:
    """Fit of two effects on the full model; None where it cannot be simulated."""
    both = combine(first.hypothesis, second.hypothesis)
    context.report_progress(f"{both.effect}: fit on the full model")
    try:
        return corrected_by_full_mesh(context, second, gauss_newton(first.problem, both, second.start, context.origin))
    except SimulationError:
        return None


def with_single_fits(context: FitContext, found: Sequence[CandidateFit], pair: CandidateFit) -> list[CandidateFit]:
    """The candidate fits with a pair, each effect of which is fitted alone as well, from what it is in the pair.

    A first fit may have stopped at a false minimum, and the pair then owes all to its other effect: that one alone is the better
    explanation, as the scores tell. The effect that explains most alone is named first.
    """
    fits = {one.hypothesis.effect: one for one in found}
    parts = components_by_effect(pair.hypothesis, pair.fitted.effect_coefficients)
    left = dict.fromkeys(parts, float("inf"))
    for name, components in parts.items():
        if one := _alone(context, pair, components):
            left[name] = one.fitted.chi_square
            known = fits.get(one.hypothesis.effect)
            if known is None or not known.refined or one.fitted.chi_square < known.fitted.chi_square:
                fits[one.hypothesis.effect] = one
    return [*fits.values(), pair._replace(fitted=in_order(pair.fitted, sorted(parts, key=lambda name: left[name])))]


def _alone(
    context: FitContext, pair: CandidateFit, components: Sequence[tuple[Hypothesis, list[float]]]
) -> CandidateFit | None:
    """One effect of a pair fitted without the other; None where it cannot be simulated."""
    part = combine(*(one for one, _ in components))
    part = replace(part, effect=components[0][0].effect)
    context.report_progress(f"{part.effect} alone: fit on the full model")
    plant = pair.fitted.coefficients[: len(PLANT_PARAMETERS)]
    try:
        fitted = gauss_newton(pair.problem, part, np.concatenate([plant, *(own for _, own in components)]), context.origin)
        alone = corrected_by_full_mesh(context, replace(pair.screening, hypothesis=part), fitted)
    except SimulationError:
        return None
    return with_mass_search(context, alone)


def in_order(fitted: FitResult, names: Sequence[str]) -> FitResult:
    """The fit of a combination with its effects in another order."""
    assert fitted.hypothesis is not None
    parts, first = fitted.hypothesis.parts, len(PLANT_PARAMETERS)
    starts = np.cumsum([first, *(len(part.directions) for part in parts)])
    order = sorted(range(len(parts)), key=lambda k: names.index(effect_name(parts[k])))
    columns = [*range(first), *(j for k in order for j in range(starts[k], starts[k + 1]))]
    return replace(
        fitted, hypothesis=combine(*(parts[k] for k in order)), coefficients=fitted.coefficients[columns],
        jacobian=fitted.jacobian[:, columns],
        covariance=fitted.covariance[np.ix_(columns, columns)],
    )  # fmt: skip
