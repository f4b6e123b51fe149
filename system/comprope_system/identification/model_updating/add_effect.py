"""Add an effect to a model: fitted on the fit runs with the plant's parameters, judged on the runs held out."""

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel

from ...report.json_output import plain
from ..comparison.compare import Comparison, compare
from ..data.campaign import Campaign
from ..diagnosis.linear_screening import promising_frequencies, screen_about_fits
from ..estimation.gauss_newton import FitResult, evaluate, gauss_newton
from ..estimation.initial_guess import best_initial_guess
from ..estimation.linearisation import effect_jacobian, point_at
from ..estimation.mass_search import fit_with_mass_search, search_rope_mass
from ..estimation.parameter_estimates import (
    Estimate,
    effect_estimates,
    fitted_model,
    keys_set_by_runs,
    plant_estimates,
    standard_error_scale,
)
from ..estimation.weighted_least_squares import LeastSquaresProblem, build_problem
from ..hypotheses.effect_hypotheses import Hypothesis, combine
from ..hypotheses.model_effects import (
    components_by_effect,
    effect_name,
    effects_in_model,
    hypotheses_named,
    shape_hypotheses,
    short_names,
)
from ..hypotheses.plant_parameters import CLOCK, PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint, collect_predictions, submit_replays
from ..progress import ProgressCallback, no_progress

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Ground:
    """What every fit to a campaign begins with: its weighed data, the model as it stands, and its plant refitted.

    `begun` has derivatives by plant and effects that are in the model already; `fitted` has both refitted.
    """

    campaign: Campaign
    problem: LeastSquaresProblem
    initial_fit: FitResult
    fitted: FitResult


def prepare(campaign: Campaign, executor: Executor, report_progress: ProgressCallback = no_progress) -> Ground:
    """Weigh the fit runs and refit plant and present effects."""
    runs = campaign.of_role("fit")
    report_progress("the model as it is")
    nominal = collect_predictions(runs, submit_replays(campaign, runs, ParameterPoint(), executor))
    posed = build_problem(campaign, runs, executor, nominal)
    # A model file could not change what runs state.
    problem = replace(posed, held=frozenset(keys_set_by_runs(campaign)))
    report_progress("plant parameters")
    hypothesis, coefficients = effects_in_model(campaign)
    start = np.concatenate([np.zeros(len(PLANT_PARAMETERS)), coefficients])
    initial_fit = evaluate(problem, hypothesis, start, ParameterPoint())
    return Ground(campaign, problem, initial_fit, fit_with_mass_search(problem, initial_fit, ParameterPoint()))


@dataclass(frozen=True)
class Added:
    """A model with an effect. Comparisons: the model as it stood, with its plant refitted, and with the effect.

    `effects` and `plant` are fitted values by their keys in the model file.
    """

    effect: str
    was_there: bool
    ground: Ground
    fitted: FitResult
    model: RopeModel
    effects: dict[str, Estimate]
    plant: dict[str, Estimate]
    before: Comparison
    refitted: Comparison
    after: Comparison

    def parameters(self) -> dict[str, Any]:
        """Fitted values by their short names; of several effects each in its own table."""
        values, names = {key: one.value for key, one in self.effects.items()}, self.effect.split(" + ")
        return short_names(names[0], values) if len(names) == 1 else {name: short_names(name, values) for name in names}

    def to_json(self) -> dict[str, Any]:
        """Errors before and after on fit and validate runs, and what was fitted."""
        errors = {"as_it_stood": self.before, "plant_refitted": self.refitted, "with_effect": self.after}
        found = {
            "effect": self.effect, "was_in_the_model": self.was_there,
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
            "misfit_per_datum": self.fitted.chi_square / max(len(self.ground.problem.data), 1),
        }  # fmt: skip
        return plain(found)


def add(campaign: Campaign, effect: str, executor: Executor, report_progress: ProgressCallback = no_progress) -> Added:
    """Fit the named effect with the plant and the effects that are there; one that is there is refitted.

    Raises InputError for a name that is none.
    """
    hypotheses_named(effect, campaign, ())
    ground = prepare(campaign, executor, report_progress)
    if effect in components_by_effect(ground.fitted.hypothesis, ground.fitted.effect_coefficients):
        return added(ground, effect, ground.fitted, executor, was_there=True)
    report_progress(f"{effect}, linearised")
    new, start = _best_start(ground, hypotheses_named(effect, campaign, promising_frequencies(ground.problem, ground.fitted)))
    report_progress(f"{effect}, on the full model")
    return added(ground, effect_name(new), fit_new(ground, new, start, ground.fitted), executor)


def _best_start(ground: Ground, tried: list[Hypothesis]) -> tuple[Hypothesis, Floats]:
    """The alternative that explains most by its linear look, and coefficients there: plant, the effect, those present."""
    problem, (old, own) = ground.problem, effects_in_model(ground.campaign)
    plant = len(PLANT_PARAMETERS)
    origin = point_at(old, [*np.zeros(plant), *own], ParameterPoint())
    columns = {one: effect_jacobian(problem, one, origin, ground.initial_fit.predictions) for one in tried}
    best = min(screen_about_fits(problem, columns, ground.fitted, ground.initial_fit), key=lambda look: look.penalised_chi_square)
    there, new = best.start[plant : plant + len(own)], best.start[plant + len(own) :]
    return best.hypothesis, np.concatenate([best.start[:plant], new, there])


def fit_new(ground: Ground, new: Hypothesis, start: Floats, known: FitResult) -> FitResult:
    """Refine a new effect with the plant and the effects that `known` has; `start`: plant, new, and perhaps known ones.

    What shapes the effect beyond its size is then freed, where it has such: a frequency, a yield curvature.
    """
    old = [part for part, _ in known.hypothesis.split_coefficients(known.effect_coefficients)] if known.hypothesis else []
    count = len(PLANT_PARAMETERS) + len(new.directions)
    begin = start if len(start) > count else np.concatenate([start, known.coefficients[len(PLANT_PARAMETERS) :]])
    begin = np.array(begin)
    begin[[k for k, one in enumerate(PLANT_PARAMETERS) if one.name in ground.problem.held]] = 0.0
    whole = combine(new, *old)
    begin = best_initial_guess(ground.problem, whole, begin, ParameterPoint(), ground.fitted, len(new.directions))
    fitted = search_rope_mass(ground.problem, gauss_newton(ground.problem, whole, begin, ParameterPoint()), ParameterPoint())
    return _shaped(ground, new, old, fitted)


def _shaped(ground: Ground, new: Hypothesis, old: list[Hypothesis], fitted: FitResult) -> FitResult:
    shapes = shape_hypotheses(new.parts or (new,), ground.problem.longest)
    if not shapes:
        return fitted
    begin = np.concatenate([fitted.coefficients, np.zeros(len(shapes))])
    freed = gauss_newton(ground.problem, combine(new, *old, *shapes), begin, ParameterPoint())
    return freed if freed.cost() < fitted.cost() else fitted


def added(ground: Ground, effect: str, fitted: FitResult, executor: Executor, was_there: bool = False) -> Added:
    """Make the model of a fit and judge it on all runs."""
    campaign, scale = ground.campaign, standard_error_scale(fitted, len(ground.problem.data))
    model = fitted_model(campaign, fitted)
    return Added(
        effect, was_there, ground, fitted, model,
        effect_estimates(fitted, scale),
        plant_estimates(campaign, fitted, scale),
        compare(campaign, executor),
        compare(replace(campaign, model=fitted_model(campaign, ground.fitted)), executor, beside_the_model(ground.fitted)),
        compare(replace(campaign, model=model), executor, beside_the_model(fitted)),
    )  # fmt: skip


def beside_the_model(fitted: FitResult) -> ParameterPoint:
    """What a fit found that belongs to the campaign, not to the model: clocks, and phases of single runs."""
    return ParameterPoint({CLOCK: fitted.point.plant[CLOCK]}, shifts=fitted.point.shifts)


def heading(one: Added) -> str:
    """What a model file's comment says about its fit."""
    campaign = one.before.campaign
    files = ", ".join(run.file for run in campaign.of_role("fit"))
    replaced = keys_set_by_runs(campaign)
    effects = {key: value for key, value in one.effects.items() if value.standard_error > 0.0}
    plant = {key: value for key, value in one.plant.items() if key not in replaced}
    shifts = one.fitted.point.shifts
    lines = [
        f'{campaign.model_path.name} with {one.effect}, fitted to the campaign "{campaign.name}" ({files}).',
        f"Error on these runs {_percent(one.before.fit_nrmse)} before, {_percent(one.after.fit_nrmse)} after;",
        f"on runs held out {_percent(one.before.validate_nrmse)} before, {_percent(one.after.validate_nrmse)} after.",
        "Fitted values with one standard deviation:",
        *(f"  {key} = {value.formatted()}" for key, value in effects.items()),
        *(f"  {key} = {value.formatted()} (was {value.before:.4g})" for key, value in plant.items()),
        *(f"  {key} in {file}: {shift:+.3g} from that" for file, own in shifts.items() for key, shift in own.items()),
    ]
    return "\n".join(lines)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if np.isfinite(share) else "unknown"
