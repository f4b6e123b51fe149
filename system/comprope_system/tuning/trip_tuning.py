"""Tuning of one trip: for each travel time the best S-curve and the best of all other families, evaluated with the full model."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from comprope.drive.parameters import Drive
from comprope.errors import InputError
from comprope.rope.model_file import validated

from ..vibration.modal.hanging_string import side_string
from ..vibration.reduced_model.swing import SIDES, Swing, observation_time, reduced_swing
from . import travel_time_tradeoff
from .fmu_validation import DepartureTrace, simulate_route
from .search import lower_bound
from .search.profile_families import KINDS, Route, trajectory_of
from .search.quasi_random_search import Candidate, Search
from .search.trajectory_optimisation import Objective, optimised_drive
from .task import Task, evaluated, periods, reduced_model_of, slowest_bounce, with_sheave_factor
from .travel_time_tradeoff import FREE

TARGET_RATIO = 0.97  # of the S-curve's swings: what a tuned trip is asked to stay under in both
SWING_SHARES = (0.5, 0.2)  # of the swing after the fastest trip: what time these take
MOVING_AVERAGES = (0.0, 0.12, 0.25, 0.5)  # of the slowest bounce: moving averages that trips of a free shape are tried with
FULL_MODEL_CANDIDATES = 5  # other trips, likewise
FULL_MODEL_S_CURVES = 4  # S-curves, unlike each other, that are judged on the full model


def tuned_trip(case: Mapping[str, Any]) -> dict[str, Any]:
    """`tune_trip` as a case of a sweep."""
    model = validated(case["model"], "case")
    route = Route(case["way"][0], case["way"][1], periods(model))
    drive, present = (Drive.model_validate(case[name]) for name in ("drive", "present"))
    return tune_trip(
        Task(model, drive, present, route, case["factors"], case["weight"], case["spread"], case["chosen"], case["limit"])
    )


def tune_trip(task: Task) -> dict[str, Any]:
    """All results of a trip for JSON: times in s, swings in m as [during, after]."""
    present = trajectory_of(task.drive, task.route)
    own = reduced_swing(task.reduced_model(), present, task.observation)
    if own.after <= 0.0 or own.during <= 0.0:
        raise InputError(f"trip of {task.route.distance:g} m: the rope does not swing; there is nothing to tune")
    objective = Objective((1.0 - task.weight) / own.during, task.weight / own.after)
    points = [point for factor in task.factors if (point := _point(task, factor, objective))]
    chosen, present_result = _chosen(task, points), evaluated(task, task.present, "present", own)
    least = travel_time_tradeoff.least_times(task, SWING_SHARES, present_result["full"][1])
    return {
        "origin": task.route.origin, "destination": task.route.destination,
        "present": present_result, "points": points,
        "period": _period(task), "bound": _bound(task, [one["factor"] for one in points]),
        "saved": travel_time_tradeoff.take_faster(least, points, present_result),
        "installed": _fmu_validation(task, chosen) if chosen else None,
        "robust": _robust(task, chosen) if chosen else None,
    }  # fmt: skip


def _chosen(task: Task, points: Sequence[dict[str, Any]]) -> dict[str, Any] | None:
    """The point that is validated with FMUs; None if no point meets the limit."""
    if task.limit is not None:
        return next((one for one in points if max(one["tuned"]["full"]) <= task.limit), None)
    return min(points, key=lambda one: abs(one["factor"] - task.chosen), default=None)


def _point(task: Task, factor: float, objective: Objective) -> dict[str, Any] | None:
    """The best S-curve and the best other trip for a travel time; None if no other is so fast."""
    time = factor * trajectory_of(task.drive, task.route).duration
    search = _search(task, time, objective)
    curves = search.best("S-curve", count=FULL_MODEL_S_CURVES)
    if not curves:
        return None
    cost = _full_cost(objective)
    s_curve = min((evaluated(task, one.drive, "S-curve", one.swings[0]) for one in curves), key=cost)
    stricter = Objective(
        objective.during,
        objective.after,
        Swing(TARGET_RATIO * curves[0].swings[0].during, TARGET_RATIO * curves[0].swings[0].after),
    )
    others = _other_kinds(task, time, stricter, curves[0])
    ranked = sorted(others, key=lambda one: stricter.cost(one[2]))
    tried = {kind: [swing.during, swing.after] for kind, _, swing in ranked[::-1]}
    best = ranked[:FULL_MODEL_CANDIDATES]
    results = [s_curve, *(evaluated(task, drive, kind, swing) for kind, drive, swing in best)]
    caps = Objective(
        objective.during, objective.after, Swing(TARGET_RATIO * s_curve["full"][0], TARGET_RATIO * s_curve["full"][1])
    )
    return {"factor": factor, "time": time, "s_curve": s_curve, "tuned": min(results, key=_full_cost(caps)), "tried": tried}


def _full_cost(objective: Objective) -> Any:
    return lambda results: objective.cost(Swing(*results["full"]))


def _search(task: Task, time: float, objective: Objective) -> Search:
    cases = task.reduced_models()

    def evaluate(drive: Drive) -> list[Swing]:
        trajectory = trajectory_of(drive, task.route)
        return [reduced_swing(case, trajectory, task.observation) for case in cases]

    return Search(task.drive, [task.route], time, evaluate, lambda swings: max(map(objective.cost, swings)))


def _other_kinds(task: Task, time: float, objective: Objective, s_curve: Candidate) -> list[tuple[str, Drive, Swing]]:
    """The best of each other family, with its swing of the nominal reduced model."""
    found, search = [], _search(task, time, objective)
    for kind in KINDS:
        if kind != "S-curve":
            found += [(kind, one.drive, one.swings[0]) for one in search.best(kind, [s_curve.shares], count=2)]
    first = trajectory_of(min(found, key=lambda one: objective.cost(one[2]))[1] if found else s_curve.drive, task.route)
    for average in MOVING_AVERAGES:
        smoothing = average * slowest_bounce(task)
        drive = optimised_drive(
            task.drive, task.route, time, task.reduced_models(), task.observation, objective, first, smoothing
        )
        if drive:
            found.append((FREE, drive, reduced_swing(task.reduced_model(), trajectory_of(drive, task.route), task.observation)))
    return found


def _period(task: Task) -> float:
    """Longest natural period [s] of either side with the car at the destination."""
    return max(side_string(task.model, task.route.destination, side).period() for side in SIDES)


def _bound(task: Task, factors: Sequence[float]) -> dict[str, Any]:
    """Lower bound of the spectrum at each travel time, and of the travel time for each fraction of the present swing."""
    present, period = trajectory_of(task.drive, task.route), _period(task)
    own = lower_bound.speed_spectrum(present, period)
    least = [lower_bound.minimum_spectrum(task.drive, task.route, factor * present.duration, period) / own for factor in factors]
    times = [lower_bound.minimum_time(task.drive, task.route, present, period, share) for share in SWING_SHARES]
    return {
        "least": [one if np.isfinite(one) else None for one in least],
        "too_short": lower_bound.unavoidable_share(present.duration, period),
        "times": [one if np.isfinite(one) else None for one in times],
    }  # fmt: skip


def fmu_case(case: Mapping[str, Any]) -> list[float]:
    """The swing [m] during and after one trip of a drive, by its FMUs: a case of a sweep."""
    model = validated(case["model"], "case")
    drive, route = Drive.model_validate(case["drive"]), Route(case["way"][0], case["way"][1], periods(model))
    swing = simulate_route(model, reduced_model_of(model), drive, route, observation_time(model, route.destination)).swing()
    return [swing.during, swing.after]


def drive_of(task: Task, results: Mapping[str, Any]) -> Drive:
    """The drive of a result."""
    return Drive.model_validate(task.drive.model_dump() | results["drive"])


def _fmu_validation(task: Task, point: Mapping[str, Any]) -> dict[str, Any]:
    """Simulation of the present drive, the best S-curve and the tuned drive of a point with FMUs; traces for the figure."""
    drives = {"present": task.present, "s_curve": drive_of(task, point["s_curve"]), "tuned": drive_of(task, point["tuned"])}
    results = {}
    for name, drive in drives.items():
        trace = simulate_route(task.model, task.reduced_model(), drive, task.route, task.observation)
        results[name] = _trace_json(task, trace, drive)
    return {"factor": point["factor"], **results}


def _trace_json(task: Task, trace: DepartureTrace, drive: Drive) -> dict[str, Any]:
    swing, trajectory = trace.swing(), trajectory_of(drive, task.route, 0.5)
    every = slice(None, None, 5)
    return {
        "swing": [swing.during, swing.after], "end": trace.end, "time": trace.time[every].tolist(),
        "largest": np.maximum.reduceat(trace.largest(), np.arange(0, len(trace.time), 5)).tolist(),
        "speed": [trajectory.at(one).velocity for one in trace.time[every]],
        "acceleration": [trajectory.at(one).acceleration for one in trace.time[every]],
    }  # fmt: skip


def _robust(task: Task, point: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Swings of the full model with the sheave 10 % lighter and heavier."""
    found = []
    for factor in (0.9, 1.1):
        model, case = with_sheave_factor(task.model, factor), task.reduced_model(factor)
        row: dict[str, Any] = {"mass": factor}
        for name in ("s_curve", "tuned"):
            swing = simulate_route(model, case, drive_of(task, point[name]), task.route, task.observation, direct=True).swing()
            row[name] = [swing.during, swing.after]
        found.append(row)
    return found
