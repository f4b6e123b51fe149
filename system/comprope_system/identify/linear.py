"""A model linearised about a point: predictions and their derivatives by the coefficients of directions."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .hypotheses import NUISANCES, Direction, Hypothesis
from .point import Point, Predictions
from .problem import Problem

Floats = NDArray[np.float64]
RELATIVE = 0.02  # of a plant parameter: the step of a difference
ABSOLUTE = 0.01  # of a coefficient that is not relative


@dataclass(frozen=True)
class Linear:
    """Whitened predictions y (N,) at a point and their derivatives (N, k) by k coefficients."""

    y: Floats
    by: Floats


def by_plant(problem: Problem, point: Point, y: Floats, names: Sequence[Direction] = NUISANCES) -> Floats:
    """Derivatives (N, nuisances) by the plant's coefficients at a point whose predictions are y."""
    steps = [RELATIVE if one.relative else ABSOLUTE for one in names]
    moved = [
        replace(point, plant=dict(point.plant) | {one.name: point.plant.get(one.name, 0.0) + h})
        for one, h in zip(names, steps, strict=True)
    ]
    found = problem.predictions(*moved)
    return np.column_stack([(problem.whitened(one) - y) / h for one, h in zip(found, steps, strict=True)])


def by_effect(problem: Problem, hypothesis: Hypothesis, plant: Point, coefficients: Sequence[float], at: Predictions) -> Floats:
    """Derivatives (N, directions) by the coefficients of an effect, or of several; `at` are the predictions there.

    From zero the step is the whole typical value, since some effects have no derivative there.
    """
    y, own = problem.whitened(at), list(coefficients)
    steps = [_step(c, one) for c, one in zip(own, hypothesis.directions, strict=True)]
    faults = [part.is_instrument for part, _ in hypothesis.shares(own) for _ in part.directions]
    physical = [k for k, fault in enumerate(faults) if not fault]
    moved = problem.predictions(*(with_effect(plant, hypothesis, _moved(own, k, steps[k])) for k in physical))
    columns = {k: (problem.whitened(one) - y) / steps[k] for k, one in zip(physical, moved, strict=True)}
    columns |= {k: _by_instrument(problem, hypothesis.directions[k], at) for k, fault in enumerate(faults) if fault}
    return np.column_stack([columns[k] for k in range(len(own))])


def _moved(coefficients: list[float], place: int, step: float) -> list[float]:
    """The coefficients with one of them moved."""
    return [c + (step if k == place else 0.0) for k, c in enumerate(coefficients)]


def _step(coefficient: float, direction: Direction) -> float:
    """A tenth of a coefficient, or the whole typical value from zero; turned round at the upper bound."""
    step = 1.0 if abs(coefficient) < 0.1 else 0.1 * coefficient
    return step if direction.lower <= coefficient + step <= direction.upper else -step


def unit_points(origin: Point, hypothesis: Hypothesis) -> list[Point]:
    """One point for each direction of an effect: its typical value, the others at zero."""
    count = len(hypothesis.directions)
    return [with_effect(origin, hypothesis, [float(j == k) for j in range(count)]) for k in range(count)]


def with_effect(point: Point, hypothesis: Hypothesis, coefficients: Sequence[float]) -> Point:
    """The point with an effect of these coefficients beside those it has."""
    return replace(point, effects=dict(point.effects) | hypothesis.parameters(list(coefficients)))


def _by_instrument(problem: Problem, direction: Direction, at: Predictions) -> Floats:
    """Derivative (N,) of one channel by its gain, offset or delay, from the predictions themselves."""
    ((key, size),) = direction.changes.items()
    _, effect, column = key.split(".", 2)
    moved = {}
    for run in problem.runs:
        value = at[run.file, column]
        slope = {"sensor_gain": value, "sensor_offset": np.ones_like(value)}.get(effect)
        moved[run.file, column] = size * (-np.gradient(value, run.time) if slope is None else slope)
    return problem.column(moved)
