"""Add an effect to a model: fitted on the fit runs together with the plant parameters, validated on the runs held out."""

from concurrent.futures import Executor
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel

from ...report.json_output import plain
from ..comparison.compare import Comparison, compare
from ..data.campaign import Campaign
from ..diagnosis.linear_screening import promising_frequencies, screen_about_fits
from ..estimation.coarse_to_fine import fit_coarse_to_fine, fit_from_file, with_derivatives
from ..estimation.effect_responses import effect_responses
from ..estimation.gauss_newton import FitResult
from ..estimation.identifiability import identifiability
from ..estimation.initial_guess import best_initial_guess, chi_squares
from ..estimation.linearisation import instrument_jacobian, point_at
from ..estimation.mass_search import search_rope_mass
from ..estimation.parameter_estimates import (
    Estimate,
    effect_estimates,
    fitted_model,
    keys_set_by_runs,
    plant_estimates,
    standard_error_scale,
)
from ..estimation.weighted_least_squares import LeastSquaresProblem, build_problem
from ..prediction.effect_hypotheses import Hypothesis, combine
from ..prediction.model_effects import (
    components_by_effect,
    effect_name,
    effects_in_model,
    hypotheses_named,
    shape_hypotheses,
    short_names,
    stated_effect,
)
from ..prediction.parameter_point import ParameterPoint, collect_predictions, submit_replays
from ..prediction.plant_parameters import CLOCK, PLANT_PARAMETERS
from ..progress import ProgressCallback, no_progress

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class BaselineFit:
    """What every fit to a campaign starts from: its whitened data and the model with its plant parameters refitted.

    `initial_fit` has the derivatives by plant parameters and effects that are in the model already; `fitted` has both refitted.
    """

    campaign: Campaign
    problem: LeastSquaresProblem
    initial_fit: FitResult
    fitted: FitResult


def fit_baseline(campaign: Campaign, executor: Executor, report_progress: ProgressCallback = no_progress) -> BaselineFit:
    """Whiten the fit runs, and refit plant parameters and the effects that are in the model."""
    runs = campaign.of_role("fit")
    report_progress("simulating the model as given")
    nominal = collect_predictions(runs, submit_replays(campaign, runs, ParameterPoint(), executor))
    posed = build_problem(campaign, runs, executor, nominal)
    # A model file could not change what runs state.
    problem = replace(posed, held=posed.held | keys_set_by_runs(campaign))
    report_progress("fitting the plant parameters")
    hypothesis, coefficients = effects_in_model(campaign)
    start = np.concatenate([np.zeros(len(PLANT_PARAMETERS)), coefficients])
    _, initial, fitted = fit_from_file(problem, hypothesis, start, ParameterPoint(), nominal)
    return BaselineFit(campaign, problem, replace(initial, predictions=nominal), fitted)


@dataclass(frozen=True)
class UpdatedModel:
    """A model with an effect. Comparisons: the model as given, with its plant parameters refitted, and with the effect.

    `effects` and `plant` are estimates by their keys in the model file; `already_present`: the effect was refitted, not added.
    """

    effect: str
    already_present: bool
    baseline: BaselineFit
    fitted: FitResult
    model: RopeModel
    effects: dict[str, Estimate]
    plant: dict[str, Estimate]
    before: Comparison
    refitted: Comparison
    after: Comparison

    @property
    def reduced_chi_square(self) -> float:
        """Chi-square of the fit over the number of whitened data."""
        return self.fitted.chi_square / max(len(self.baseline.problem.data), 1)

    def parameters(self) -> dict[str, Any]:
        """Fitted values by their short names; of several effects each in its own table."""
        values, names = {key: one.value for key, one in self.effects.items()}, self.effect.split(" + ")
        return short_names(names[0], values) if len(names) == 1 else {name: short_names(name, values) for name in names}

    def to_json(self) -> dict[str, Any]:
        """Errors before and after on fit and validation runs, and estimates; `misfit_per_datum` is an older name."""
        errors = {"as_it_stood": self.before, "plant_refitted": self.refitted, "with_effect": self.after}
        found = {
            "effect": self.effect, "was_in_the_model": self.already_present,
            "error_before": self.before.fit_nrmse, "error_after": self.after.fit_nrmse,
            "validate_error_before": self.before.validate_nrmse, "validate_error_after": self.after.validate_nrmse,
            "parameters": self.parameters(),
            "errors": {name: {"fit": one.fit_nrmse, "validate": one.validate_nrmse} for name, one in errors.items()},
            "runs": [
                {"file": a.file, "role": a.role, "error_before": a.nrmse, "error_after": b.nrmse}
                for a, b in zip(self.before.runs, self.after.runs, strict=True)
            ],
            "by_run": {file: dict(shifts) for file, shifts in self.fitted.point.shifts.items()},
            "intervals": {key: one.to_json() for key, one in self.effects.items()},
            "plant": {key: one.to_json() for key, one in self.plant.items()},
            "identifiability": asdict(identifiability(self.fitted, self.effects)),
            "reduced_chi_square": self.reduced_chi_square,
            "misfit_per_datum": self.reduced_chi_square,
        }  # fmt: skip
        return plain(found)


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
    rough = baseline.problem.coarsened(known.point, known.predictions)
    return starts[int(np.argmin(chi_squares(rough, whole, starts, ParameterPoint())))]


def _best_start(baseline: BaselineFit, tried: list[Hypothesis]) -> tuple[Hypothesis, Floats]:
    """The alternative of least linearised chi-square, and coefficients there: plant, the effect, those present."""
    problem, (old, own) = baseline.problem, effects_in_model(baseline.campaign)
    plant = len(PLANT_PARAMETERS)
    origin = point_at(old, [*np.zeros(plant), *own], ParameterPoint())
    columns = effect_responses(problem.on_coarse_mesh(), origin, [one for one in tried if not one.follows_from_predictions])
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
        rough = baseline.problem.coarsened(known.point, known.predictions)
        begin = best_initial_guess(rough, whole, begin, base, baseline.fitted, len(new.directions))
    fitted = search_rope_mass(baseline.problem, fit_coarse_to_fine(baseline.problem, whole, begin, base), base)
    return _shaped(baseline, new, old, fitted)


def _shaped(baseline: BaselineFit, new: Hypothesis, old: list[Hypothesis], fitted: FitResult) -> FitResult:
    shapes = shape_hypotheses(new.parts or (new,), baseline.problem.longest)
    if not shapes:
        return fitted
    begin = np.concatenate([fitted.coefficients, np.zeros(len(shapes))])
    freed = fit_coarse_to_fine(baseline.problem, combine(new, *old, *shapes), begin, ParameterPoint())
    return freed if freed.cost() < fitted.cost() else fitted


def updated_model(
    baseline: BaselineFit, effect: str, fitted: FitResult, executor: Executor, already_present: bool = False
) -> UpdatedModel:
    """The model of a fit, compared with all runs."""
    campaign, fitted = baseline.campaign, with_derivatives(baseline.problem, fitted, ParameterPoint())
    scale = standard_error_scale(fitted, len(baseline.problem.data))
    model = fitted_model(campaign, fitted)
    return UpdatedModel(
        effect, already_present, baseline, fitted, model,
        effect_estimates(fitted, scale),
        plant_estimates(campaign, fitted, scale),
        compare(campaign, executor),
        compare(replace(campaign, model=fitted_model(campaign, baseline.fitted)), executor, campaign_parameters(baseline.fitted)),
        compare(replace(campaign, model=model), executor, campaign_parameters(fitted)),
    )  # fmt: skip


def campaign_parameters(fitted: FitResult) -> ParameterPoint:
    """Estimates that belong to the campaign, not to the model: the clock offset, and phases of single runs."""
    return ParameterPoint({CLOCK: fitted.point.plant[CLOCK]}, shifts=fitted.point.shifts)


def file_comment(one: UpdatedModel) -> str:
    """The comment at the head of a model file: what was fitted, to which runs, and with which error."""
    campaign = one.before.campaign
    files = ", ".join(run.file for run in campaign.of_role("fit"))
    replaced = keys_set_by_runs(campaign)
    effects = {key: value for key, value in one.effects.items() if value.standard_error > 0.0}
    plant = {key: value for key, value in one.plant.items() if key not in replaced}
    shifts = one.fitted.point.shifts
    lines = [
        f'{campaign.model_path.name} with {one.effect}, fitted to the campaign "{campaign.name}" ({files}).',
        f"NRMSE on these runs {_percent(one.before.fit_nrmse)} before, {_percent(one.after.fit_nrmse)} after;",
        f"on validation runs {_percent(one.before.validate_nrmse)} before, {_percent(one.after.validate_nrmse)} after.",
        "Estimates with one standard error:",
        *(f"  {key} = {value.formatted()}" for key, value in effects.items()),
        *(f"  {key} = {value.formatted()} (was {value.before:.4g})" for key, value in plant.items()),
        *(f"  {key} in {file}: {shift:+.3g} from that" for file, own in shifts.items() for key, shift in own.items()),
    ]
    return "\n".join(lines)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if np.isfinite(share) else "unknown"
