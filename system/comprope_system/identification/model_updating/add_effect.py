"""Add an effect to a model: fitted on the fit runs together with the plant parameters, validated on the runs held out."""

from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel

from ..data.campaign import Campaign
from ..diagnosis.linear_screening import promising_frequencies, screen_about_fits
from ..estimation.effect_responses import effect_responses
from ..estimation.gauss_newton import FitResult
from ..estimation.initial_guess import best_initial_guess, chi_squares
from ..estimation.linearisation import instrument_jacobian, point_at
from ..estimation.mass_search import search_rope_mass
from ..prediction.effect_hypotheses import Hypothesis, combine
from ..prediction.model_effects import (
    components_by_effect,
    effect_name,
    effects_in_model,
    hypotheses_named,
    shape_hypotheses,
    stated_effect,
)
from ..prediction.parameter_point import ParameterPoint
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..progress import ProgressCallback, no_progress
from .baseline_fit import BaselineFit, fit_baseline
from .updated_model import UpdatedModel, updated_model

Floats = NDArray[np.float64]


def add_effect(
    campaign: Campaign,
    effect: str,
    executor: Executor,
    report_progress: ProgressCallback = no_progress,
    stated: RopeModel | None = None,
) -> UpdatedModel:
    """Fit the named effect together with plant parameters and present effects; one that is present is refitted.

    The fit begins at the parameters that the effect has in the model `stated`, else at those that screening proposes. Raises
    `InputError` for an unknown name.
    """
    hypotheses_named(effect, campaign, ())
    baseline = fit_baseline(campaign, executor, report_progress)
    if effect in components_by_effect(baseline.fitted.hypothesis, baseline.fitted.effect_coefficients):
        return updated_model(baseline, effect, baseline.fitted, executor, already_present=True)
    if stated:
        new, coefficients = stated_effect(effect, campaign, stated)
        report_progress(f"fitting {effect}")
        start = _better_plant(baseline, new, coefficients)
        return updated_model(baseline, effect, fit_with_effect(baseline, new, start, baseline.fitted, search=False), executor)
    report_progress(f"linear screening of {effect}")
    frequencies = promising_frequencies(baseline.problem, baseline.fitted)
    new, start = _best_start(baseline, hypotheses_named(effect, campaign, frequencies))
    report_progress(f"fitting {effect}")
    return updated_model(baseline, effect_name(new), fit_with_effect(baseline, new, start, baseline.fitted), executor)


def _better_plant(baseline: BaselineFit, new: Hypothesis, coefficients: list[float]) -> Floats:
    """Coefficients (k,) of a new effect after those of the plant: of the model file or of the baseline, whichever fits better."""
    known, count = baseline.fitted, len(PLANT_PARAMETERS)
    whole = combine(new, *([known.hypothesis] if known.hypothesis else []))
    plants = (np.zeros(count), known.coefficients[:count])
    starts = [np.concatenate([plant, coefficients, known.coefficients[count:]]) for plant in plants]
    return starts[int(np.argmin(chi_squares(baseline.problem_about(known), whole, starts, ParameterPoint())))]


def _best_start(baseline: BaselineFit, tried: list[Hypothesis]) -> tuple[Hypothesis, Floats]:
    """The alternative of least linearised chi-square, and coefficients there: plant, the effect, those present."""
    problem, (old, own) = baseline.problem, effects_in_model(baseline.campaign)
    plant = len(PLANT_PARAMETERS)
    origin = point_at(old, [*np.zeros(plant), *own], ParameterPoint())
    of_changes = replace(problem, coarse=baseline.coarse)
    columns = effect_responses(of_changes, origin, [one for one in tried if not one.follows_from_predictions])
    at = baseline.initial_fit.predictions
    columns |= {one: instrument_jacobian(problem, one, origin, at) for one in tried if one.follows_from_predictions}
    screened = screen_about_fits(problem, columns, baseline.fitted, baseline.initial_fit)
    best = min(screened, key=lambda one: one.penalised_chi_square)
    there, new = best.start[plant : plant + len(own)], best.start[plant + len(own) :]
    return best.hypothesis, np.concatenate([best.start[:plant], new, there])


def fit_with_effect(
    baseline: BaselineFit, new: Hypothesis, start: Floats, known: FitResult, *, search: bool = True
) -> FitResult:
    """Fit a new effect with the plant parameters and the effects of `known`; `start`: plant, new, and perhaps known ones.

    Without `search` no other start is tried, as where a diagnosis has fitted the effect already. Parameters that change the shape
    of the effect's response are then freed as well: a frequency, a yield curvature.
    """
    old = [part for part, _ in known.hypothesis.split_coefficients(known.effect_coefficients)] if known.hypothesis else []
    count = len(PLANT_PARAMETERS) + len(new.directions)
    begin = start if len(start) > count else np.concatenate([start, known.coefficients[len(PLANT_PARAMETERS) :]])
    begin = np.array(begin)
    begin[[k for k, one in enumerate(PLANT_PARAMETERS) if one.name in baseline.problem.held]] = 0.0
    whole = combine(new, *old)
    base = ParameterPoint()
    if search:
        begin = best_initial_guess(baseline.problem_about(known), whole, begin, base, baseline.fitted, len(new.directions))
    fitted = search_rope_mass(baseline.problem, baseline.fit(whole, begin), base)
    return _shaped(baseline, new, old, fitted)


def _shaped(baseline: BaselineFit, new: Hypothesis, old: list[Hypothesis], fitted: FitResult) -> FitResult:
    shapes = shape_hypotheses(new.parts or (new,), baseline.problem.longest)
    if not shapes:
        return fitted
    begin = np.concatenate([fitted.coefficients, np.zeros(len(shapes))])
    freed = baseline.fit(combine(new, *old, *shapes), begin)
    return freed if freed.cost() < fitted.cost() else fitted
