"""Responses of the predictions to effects that a model lacks, on the mesh of a problem.

The response to a small effect is a tangent: one replay of a run gives those of all effects. An effect that acts only together
with another one that the model lacks as well, as an airflow without drag, has none; its response is a difference.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from comprope.errors import SimulationError
from comprope.rope.effects import RopeModel

from ..data.runs import Channel, Run
from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.parameter_point import ParameterPoint, run_at_point
from ..prediction.replay_sensitivities import replay_with_sensitivities
from ..settings import LINEARISATION, REPLAY
from .linearisation import with_effect
from .weighted_least_squares import LeastSquaresProblem

Floats = NDArray[np.float64]
Amounts = Mapping[str, Mapping[str, float]]


def effect_responses(
    problem: LeastSquaresProblem, point: ParameterPoint, tried: Sequence[Hypothesis]
) -> dict[Hypothesis, Floats]:
    """Responses (N, directions) by the coefficients of each effect, about a point without it.

    Effects that cannot be simulated are left out.
    """
    alone = [one for one in tried if not _requires_another(one)]
    try:
        found = _tangents(problem, point, alone)
    except SimulationError:  # a derivative has diverged, and nobody knows whose
        found = {}
    found |= dict(_differences(problem, point, [one for one in tried if one not in found]))
    return {one: found[one] for one in tried if one in found}


def one_step_away(point: ParameterPoint, hypothesis: Hypothesis) -> list[ParameterPoint]:
    """Points with one coefficient of an effect at a finite step and the others at zero, one for each direction."""
    count, step = len(hypothesis.directions), _step_of(hypothesis)
    return [with_effect(point, hypothesis, [step * (j == k) for j in range(count)]) for k in range(count)]


def _requires_another(hypothesis: Hypothesis) -> bool:
    """Whether the hypothesis fixes a parameter of another effect."""
    return any(key.split(".")[1] != hypothesis.effect for key in hypothesis.fixed)


def _tangents(
    problem: LeastSquaresProblem, point: ParameterPoint, tried: Sequence[Hypothesis]
) -> dict[Hypothesis, Floats]:
    """Responses as tangents; raises `SimulationError` where one diverges."""
    names = {one: [f"{i}.{k}" for k in range(len(one.directions))] for i, one in enumerate(tried)}
    directions: dict[str, Mapping[str, float]] = {}
    at: dict[str, Mapping[str, float]] = {}
    for one, own in names.items():
        for k, name in enumerate(own):
            directions[name], at[name] = amplitude_and_shape(one, k)
    model, channels, here = problem.campaign.model, problem.campaign.channels, problem.with_held_fixed(point)
    there = [run_at_point(model, run, here, problem.coarse) for run in problem.runs]
    step = problem.coarse * REPLAY.time_step
    jobs = [problem.executor.submit(_run_tangents, model, run, channels, directions, step, at) for run in there]
    by_run = dict(zip((run.file for run in problem.runs), (job.result() for job in jobs), strict=True))
    return {one: np.column_stack([_column(problem, by_run, name) for name in own]) for one, own in names.items()}


def amplitude_and_shape(hypothesis: Hypothesis, k: int) -> tuple[dict[str, float], dict[str, float]]:
    """Change of direction k's amplitude by a unit of its coefficient, and the parameters that act only with an amplitude."""
    values = hypothesis.parameters([float(j == k) for j in range(len(hypothesis.directions))])
    phase = hypothesis.polar[1] if hypothesis.polar else None
    amplitudes = {key for one in hypothesis.directions for key in one.changes if key != phase}
    own = {key for key in hypothesis.directions[k].changes if key != phase}
    shape = {key: value for key, value in values.items() if key not in amplitudes}
    return {key: values[key] for key in own}, shape


def _run_tangents(
    model: RopeModel, run: Run, channels: Mapping[str, Channel], directions: Amounts, step: float, at: Amounts
) -> dict[str, dict[str, Floats]]:
    """Derivatives of the channels of a run (n,) along each direction, by name."""
    return replay_with_sensitivities(model, run, channels, directions, step, at)[1]


def _column(problem: LeastSquaresProblem, by_run: Mapping[str, Mapping[str, Mapping[str, Floats]]], name: str) -> Floats:
    """Whitened derivatives (N,) along one direction."""
    return problem.column({(file, column): one for file, by in by_run.items() for column, one in by[name].items()})


def _differences(
    problem: LeastSquaresProblem, point: ParameterPoint, tried: Sequence[Hypothesis]
) -> Iterator[tuple[Hypothesis, Floats]]:
    """Responses as differences over a finite step, of all that can be simulated."""
    if not tried:
        return
    points = [point, *(there for one in tried for there in one_step_away(point, one))]
    predicted = iter(problem.attempts(*points))
    if (before := next(predicted)) is None:
        return
    y = problem.whitened(before)
    for one in tried:
        found = [at for _ in one.directions if (at := next(predicted)) is not None]
        if len(found) == len(one.directions):
            yield one, np.column_stack([problem.whitened(at) - y for at in found]) / _step_of(one)


def _step_of(hypothesis: Hypothesis) -> float:
    """Finite step of an effect's coefficients.

    It is the typical value, since friction does little until it has some size. The response to an oscillating effect is
    proportional to its amplitude, but at its typical value a resonance may displace the rope by metres.
    """
    return LINEARISATION.oscillation_step if hypothesis.polar else LINEARISATION.effect_step
