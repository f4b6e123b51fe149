"""Add an effect to a model: fitted on the fit runs with the plant's parameters, judged on the runs held out."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel

from ...report.json_output import plain
from ..comparison.compare import Comparison, compare
from ..data.campaign import Campaign
from ..diagnosis.linear_screening import looks_from, promising_frequencies
from ..estimation.gauss_newton import Fitted, evaluate, refine
from ..estimation.initial_guess import best_start
from ..estimation.linearisation import by_effect, point_of
from ..estimation.mass_search import brought_into_step, refitted
from ..estimation.parameter_estimates import Value, effect_results, model_of, plant_results, set_by_runs, widening
from ..estimation.weighted_least_squares import Problem, pose
from ..hypotheses.effect_hypotheses import Hypothesis, together
from ..hypotheses.model_effects import alternatives, grouped, name_of, present, shapes_of, short_names
from ..hypotheses.plant_parameters import CLOCK, NUISANCES
from ..prediction.parameter_point import Point, gathered, submit

Floats = NDArray[np.float64]
Say = Callable[[str], None]


@dataclass(frozen=True)
class Ground:
    """What every fit to a campaign begins with: its weighed data, the model as it stands, and its plant refitted.

    `begun` has derivatives by plant and effects that are in the model already; `fitted` has both refitted.
    """

    campaign: Campaign
    problem: Problem
    begun: Fitted
    fitted: Fitted


def prepare(campaign: Campaign, executor: Executor, say: Say = lambda _: None) -> Ground:
    """Weigh the fit runs and refit plant and present effects."""
    runs = campaign.of_role("fit")
    say("the model as it is")
    nominal = gathered(runs, submit(campaign, runs, Point(), executor))
    posed = pose(campaign, runs, executor, nominal)
    # A model file could not change what runs state.
    problem = replace(posed, held=frozenset(set_by_runs(campaign)))
    say("plant parameters")
    hypothesis, coefficients = present(campaign)
    start = np.concatenate([np.zeros(len(NUISANCES)), coefficients])
    begun = evaluate(problem, hypothesis, start, Point())
    return Ground(campaign, problem, begun, refitted(problem, begun, Point()))


@dataclass(frozen=True)
class Added:
    """A model with an effect. Comparisons: the model as it stood, with its plant refitted, and with the effect.

    `effects` and `plant` are fitted values by their keys in the model file.
    """

    effect: str
    was_there: bool
    ground: Ground
    fitted: Fitted
    model: RopeModel
    effects: dict[str, Value]
    plant: dict[str, Value]
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
            "misfit_per_datum": self.fitted.misfit / max(len(self.ground.problem.data), 1),
        }  # fmt: skip
        return plain(found)


def add(campaign: Campaign, effect: str, executor: Executor, say: Say = lambda _: None) -> Added:
    """Fit the named effect with the plant and the effects that are there; one that is there is refitted.

    Raises InputError for a name that is none.
    """
    alternatives(effect, campaign, ())
    ground = prepare(campaign, executor, say)
    if effect in grouped(ground.fitted.hypothesis, ground.fitted.effect_coefficients):
        return added(ground, effect, ground.fitted, executor, was_there=True)
    say(f"{effect}, linearised")
    new, start = _best_start(ground, alternatives(effect, campaign, promising_frequencies(ground.problem, ground.fitted)))
    say(f"{effect}, on the full model")
    return added(ground, name_of(new), fit_new(ground, new, start, ground.fitted), executor)


def _best_start(ground: Ground, tried: list[Hypothesis]) -> tuple[Hypothesis, Floats]:
    """The alternative that explains most by its linear look, and coefficients there: plant, the effect, those present."""
    problem, (old, own) = ground.problem, present(ground.campaign)
    plant = len(NUISANCES)
    origin = point_of(old, [*np.zeros(plant), *own], Point())
    columns = {one: by_effect(problem, one, origin, ground.begun.predictions) for one in tried}
    best = min(looks_from(problem, columns, ground.fitted, ground.begun), key=lambda look: look.strained)
    there, new = best.start[plant : plant + len(own)], best.start[plant + len(own) :]
    return best.hypothesis, np.concatenate([best.start[:plant], new, there])


def fit_new(ground: Ground, new: Hypothesis, start: Floats, known: Fitted) -> Fitted:
    """Refine a new effect with the plant and the effects that `known` has; `start`: plant, new, and perhaps known ones.

    What shapes the effect beyond its size is then freed, where it has such: a frequency, a yield curvature.
    """
    old = [part for part, _ in known.hypothesis.shares(known.effect_coefficients)] if known.hypothesis else []
    count = len(NUISANCES) + len(new.directions)
    begin = start if len(start) > count else np.concatenate([start, known.coefficients[len(NUISANCES) :]])
    begin = np.array(begin)
    begin[[k for k, one in enumerate(NUISANCES) if one.name in ground.problem.held]] = 0.0
    whole = together(new, *old)
    begin = best_start(ground.problem, whole, begin, Point(), ground.fitted, len(new.directions))
    fitted = brought_into_step(ground.problem, refine(ground.problem, whole, begin, Point()), Point())
    return _shaped(ground, new, old, fitted)


def _shaped(ground: Ground, new: Hypothesis, old: list[Hypothesis], fitted: Fitted) -> Fitted:
    shapes = shapes_of(new.parts or (new,), ground.problem.longest)
    if not shapes:
        return fitted
    begin = np.concatenate([fitted.coefficients, np.zeros(len(shapes))])
    freed = refine(ground.problem, together(new, *old, *shapes), begin, Point())
    return freed if freed.cost() < fitted.cost() else fitted


def added(ground: Ground, effect: str, fitted: Fitted, executor: Executor, was_there: bool = False) -> Added:
    """Make the model of a fit and judge it on all runs."""
    campaign, scale = ground.campaign, widening(fitted, len(ground.problem.data))
    model = model_of(campaign, fitted)
    return Added(
        effect, was_there, ground, fitted, model,
        effect_results(fitted, scale),
        plant_results(campaign, fitted, scale),
        compare(campaign, executor),
        compare(replace(campaign, model=model_of(campaign, ground.fitted)), executor, beside_the_model(ground.fitted)),
        compare(replace(campaign, model=model), executor, beside_the_model(fitted)),
    )  # fmt: skip


def beside_the_model(fitted: Fitted) -> Point:
    """What a fit found that belongs to the campaign, not to the model: clocks, and phases of single runs."""
    return Point({CLOCK: fitted.point.plant[CLOCK]}, shifts=fitted.point.shifts)


def heading(one: Added) -> str:
    """What a model file's comment says about its fit."""
    campaign = one.before.campaign
    files = ", ".join(run.file for run in campaign.of_role("fit"))
    replaced = set_by_runs(campaign)
    effects = {key: value for key, value in one.effects.items() if value.deviation > 0.0}
    plant = {key: value for key, value in one.plant.items() if key not in replaced}
    shifts = one.fitted.point.shifts
    lines = [
        f'{campaign.model_path.name} with {one.effect}, fitted to the campaign "{campaign.name}" ({files}).',
        f"Error on these runs {_percent(one.before.fit_nrmse)} before, {_percent(one.after.fit_nrmse)} after;",
        f"on runs held out {_percent(one.before.validate_nrmse)} before, {_percent(one.after.validate_nrmse)} after.",
        "Fitted values with one standard deviation:",
        *(f"  {key} = {value.told()}" for key, value in effects.items()),
        *(f"  {key} = {value.told()} (was {value.before:.4g})" for key, value in plant.items()),
        *(f"  {key} in {file}: {shift:+.3g} from that" for file, own in shifts.items() for key, shift in own.items()),
    ]
    return "\n".join(lines)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if np.isfinite(share) else "unknown"
