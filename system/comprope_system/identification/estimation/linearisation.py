"""Linearisation of a model about a point: predictions and their derivatives by the coefficients of a fit."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi, remainder

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel
from comprope.rope.model_file import with_changes
from comprope.rope.parameters.parameter_vector import DECLARED
from comprope.rope.simulator.rope import values_of

from ..data.runs import Channel, Run
from ..prediction.effect_hypotheses import SENSOR_HEIGHT, Hypothesis
from ..prediction.parameter_point import ParameterPoint, Predictions, run_at_point
from ..prediction.plant_parameters import CLOCK, PLANT_PARAMETERS, Direction
from ..prediction.replay import relative_to_rest, sensor_heights
from ..prediction.replay_sensitivities import replay_with_sensitivities
from ..settings import LINEARISATION, REPLAY
from .weighted_least_squares import LeastSquaresProblem

Floats = NDArray[np.float64]
Tangents = tuple[dict[str, Floats], dict[int, dict[str, Floats]]]


def point_at(hypothesis: Hypothesis | None, coefficients: Sequence[float], base: ParameterPoint) -> ParameterPoint:
    """Point of some coefficients (plant first), added to the effects of `base`."""
    names = [one.name for one in PLANT_PARAMETERS]
    plant = replace(base, plant=dict(zip(names, map(float, coefficients[: len(names)]), strict=True)))
    return with_effect(plant, hypothesis, [float(c) for c in coefficients[len(names) :]]) if hypothesis else plant


def with_effect(point: ParameterPoint, hypothesis: Hypothesis, coefficients: Sequence[float]) -> ParameterPoint:
    """The point with an effect of these coefficients added to its own."""
    own = list(coefficients)
    return replace(
        point, effects=dict(point.effects) | hypothesis.parameters(own), shifts=_merged(point.shifts, hypothesis.shifts(own))
    )


def _merged(
    first: Mapping[str, Mapping[str, float]], second: Mapping[str, Mapping[str, float]]
) -> dict[str, Mapping[str, float]]:
    return {file: {**first.get(file, {}), **second.get(file, {})} for file in dict.fromkeys([*first, *second])}


def linearise(
    problem: LeastSquaresProblem, hypothesis: Hypothesis | None, x: Floats, base: ParameterPoint
) -> tuple[Predictions, Floats]:
    """Predictions at the coefficients x (k,) and their whitened derivatives (N, k), from one replay of each run.

    Raises `SimulationError` where the simulation fails.
    """
    here, directions = problem.with_held_fixed(point_at(hypothesis, list(x), base)), problem.directions(hypothesis)
    steps = [
        LINEARISATION.parameter_step if c + LINEARISATION.parameter_step <= one.upper else -LINEARISATION.parameter_step
        for c, one in zip(x, directions, strict=True)
    ]
    moved = [x + step * (np.arange(len(x)) == k) for k, step in enumerate(steps)]
    there = [problem.with_held_fixed(point_at(hypothesis, list(one), base)) for one in moved]
    campaign = problem.campaign
    jobs = [
        problem.executor.submit(
            run_tangents, campaign.model, run, campaign.channels, here, list(zip(there, steps, strict=True)), problem.coarse
        )
        for run in problem.runs
    ]
    found = dict(zip((run.file for run in problem.runs), (job.result() for job in jobs), strict=True))
    at = {(file, column): values for file, (shown, _) in found.items() for column, values in shown.items()}
    columns = [_column(problem, hypothesis, here, k, found, at) for k in range(len(directions))]
    return at, np.column_stack(columns) if columns else np.zeros((len(problem.data), 0))


def _column(
    problem: LeastSquaresProblem,
    hypothesis: Hypothesis | None,
    here: ParameterPoint,
    k: int,
    found: Mapping[str, Tangents],
    at: Predictions,
) -> Floats:
    """Derivatives (N,) by coefficient k at the point `here`."""
    if k < len(PLANT_PARAMETERS) and PLANT_PARAMETERS[k].name == CLOCK:
        runs = {run.file: run for run in problem.runs}
        return problem.column({place: _delay_derivative(runs[place[0]], value) for place, value in at.items()})
    if hypothesis and k >= len(PLANT_PARAMETERS) and hypothesis.instrument_directions[k - len(PLANT_PARAMETERS)]:
        return _instrument_column(problem, hypothesis.directions[k - len(PLANT_PARAMETERS)], here, at)
    return problem.column({(file, column): values for file, (_, by) in found.items() for column, values in by.get(k, {}).items()})


def run_tangents(
    model: RopeModel,
    run: Run,
    channels: Mapping[str, Channel],
    here: ParameterPoint,
    neighbours: Sequence[tuple[ParameterPoint, float]],
    coarse: float = 1.0,
) -> Tangents:
    """Channels of a run at a point, and their derivatives towards each of some points a step away, by number.

    `neighbours` are (point, step); one that changes no model parameter has no derivative. Elements and time steps are `coarse`
    times as long.
    """
    moved_run = run_at_point(model, run, here, coarse)
    values = _values(with_changes(model, here.changes(model, run), run.file))
    directions = {}
    for k, (point, step) in enumerate(neighbours):
        moved = _values(with_changes(model, point.changes(model, run), run.file))
        change = {key: _difference(key, value, values.get(key, _neutral(key))) / step for key, value in moved.items()}
        if amounts := {key: amount for key, amount in change.items() if amount}:
            directions[str(k)] = amounts
    shown, by = replay_with_sensitivities(model, moved_run, channels, directions, coarse * REPLAY.time_step)
    return shown.values, {int(k): one for k, one in by.items()}


def _values(model: RopeModel) -> dict[str, float]:
    """Every number of a model by its key, with the errors of sensors' heights, to which the rope's motion gives derivatives."""
    heights = {f"effects.{SENSOR_HEIGHT}.{column}": error for column, error in sensor_heights(model).items()}
    return values_of(model) | heights


def _neutral(key: str) -> float:
    return DECLARED[key].neutral if key in DECLARED else 0.0


def _difference(key: str, a: float, b: float) -> float:
    """Difference a - b of a parameter's values; of angles the one within half a turn."""
    return remainder(a - b, 2.0 * pi) if key in DECLARED and DECLARED[key].unit == "rad" else a - b


def instrument_jacobian(
    problem: LeastSquaresProblem, hypothesis: Hypothesis, here: ParameterPoint, at: Predictions
) -> Floats:
    """Derivatives (N, directions) by the coefficients of an instrument's fault; `at` are the predictions at the point `here`."""
    return np.column_stack([_instrument_column(problem, one, here, at) for one in hypothesis.directions])


def _instrument_column(problem: LeastSquaresProblem, direction: Direction, here: ParameterPoint, at: Predictions) -> Floats:
    """Derivative (N,) of one channel by its gain, offset, delay or drift, from the predictions alone."""
    ((key, size),) = direction.changes.items()
    column, channels = key.split(".", 2)[2], problem.campaign.channels
    moved = {
        (run.file, column): size * instrument_slope(key, here, run, at[run.file, column], channels) for run in problem.runs
    }
    return problem.column(moved)


def instrument_slope(
    key: str, here: ParameterPoint, run: Run, value: Floats, channels: Mapping[str, Channel]
) -> Floats:
    """Derivative (n,) of the predicted `value` (n,) of a channel by the parameter `key` of its instrument, relative to rest."""
    _, effect, column = key.split(".", 2)
    if effect == "sensor_gain":
        slope = value / here.effects.get(key, 1.0)
    elif effect == "sensor_delay":
        slope = _delay_derivative(run, value)
    else:
        slope = {"sensor_offset": np.ones_like(value), "sensor_drift": run.time - run.time[0]}[effect]
    return relative_to_rest({column: slope}, run, channels)[column]


def _delay_derivative(run: Run, value: Floats) -> Floats:
    """Derivative of a channel (n,) by its delay [s]."""
    return np.asarray(-np.gradient(value, run.time))
