"""Tuning of one trip: for each travel time the best S-curve and the best of all other families, evaluated with the full model."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from comprope.drive.parameters import Drive
from comprope.errors import InputError
from comprope.rope.model_file import validated

from ..modal.hanging_string import side_string
from ..reduced_model.swing import SIDES, Swing, small_swing, tail
from . import travel_time_tradeoff
from .fmu_validation import Trace, installed
from .search import lower_bound
from .search.profile_families import KINDS, Way, course_of
from .search.quasi_random_search import Candidate, Search
from .search.trajectory_optimisation import Goal, free_drive
from .task import Task, case_of, heavier, periods, slowest_bounce, told_of
from .travel_time_tradeoff import FREE

BETTER = 0.97  # of the S-curve's swings: what a tuned trip is asked to stay under in both
SAVED = (0.5, 0.2)  # of the swing after the fastest trip: what time these take
AVERAGES = (0.0, 0.12, 0.25, 0.5)  # of the slowest bounce: moving averages that trips of a free shape are tried with
OTHERS = 5  # other trips, likewise
CURVES = 4  # S-curves, unlike each other, that are judged on the full model


def tuned_trip(case: Mapping[str, Any]) -> dict[str, Any]:
    """`tuning` as a case of a sweep."""
    model = validated(case["model"], "case")
    way = Way(case["way"][0], case["way"][1], periods(model))
    drive, present = (Drive.model_validate(case[name]) for name in ("drive", "present"))
    return tuning(
        Task(model, drive, present, way, case["factors"], case["weight"], case["spread"], case["chosen"], case["limit"])
    )


def tuning(task: Task) -> dict[str, Any]:
    """All results of a trip for JSON: times in s, swings in m as [during, after]."""
    present = course_of(task.drive, task.way)
    own = small_swing(task.case(), present, task.watched)
    if own.after <= 0.0 or own.during <= 0.0:
        raise InputError(f"trip of {task.way.distance:g} m: the rope does not swing; there is nothing to tune")
    goal = Goal((1.0 - task.weight) / own.during, task.weight / own.after)
    points = [point for factor in task.factors if (point := _point(task, factor, goal))]
    chosen, now = _chosen(task, points), told_of(task, task.present, "present", own)
    return {
        "origin": task.way.origin, "destination": task.way.destination,
        "present": now, "points": points,
        "period": _period(task), "bound": _bound(task, [one["factor"] for one in points]),
        "saved": travel_time_tradeoff.sooner(travel_time_tradeoff.saved(task, SAVED, now["full"][1]), points, now),
        "installed": _installed(task, chosen) if chosen else None,
        "robust": _robust(task, chosen) if chosen else None,
    }  # fmt: skip


def _chosen(task: Task, points: Sequence[dict[str, Any]]) -> dict[str, Any] | None:
    """The point that is validated with FMUs; None if no point meets the limit."""
    if task.limit is not None:
        return next((one for one in points if max(one["tuned"]["full"]) <= task.limit), None)
    return min(points, key=lambda one: abs(one["factor"] - task.chosen), default=None)


def _point(task: Task, factor: float, goal: Goal) -> dict[str, Any] | None:
    """The best S-curve and the best other trip for a travel time; None if no other is so fast."""
    time = factor * course_of(task.drive, task.way).duration
    search = _search(task, time, goal)
    curves = search.best("S-curve", count=CURVES)
    if not curves:
        return None
    cost = _full_cost(goal)
    s_curve = min((told_of(task, one.drive, "S-curve", one.swings[0]) for one in curves), key=cost)
    stricter = Goal(goal.during, goal.after, Swing(BETTER * curves[0].swings[0].during, BETTER * curves[0].swings[0].after))
    others = _others(task, time, stricter, curves[0])
    ranked = sorted(others, key=lambda one: stricter.cost(one[2]))
    tried = {kind: [swing.during, swing.after] for kind, _, swing in ranked[::-1]}
    best = ranked[:OTHERS]
    told = [s_curve, *(told_of(task, drive, kind, swing) for kind, drive, swing in best)]
    caps = Goal(goal.during, goal.after, Swing(BETTER * s_curve["full"][0], BETTER * s_curve["full"][1]))
    return {"factor": factor, "time": time, "s_curve": s_curve, "tuned": min(told, key=_full_cost(caps)), "tried": tried}


def _full_cost(goal: Goal) -> Any:
    return lambda told: goal.cost(Swing(*told["full"]))


def _search(task: Task, time: float, goal: Goal) -> Search:
    cases = task.cases()

    def judge(drive: Drive) -> list[Swing]:
        course = course_of(drive, task.way)
        return [small_swing(case, course, task.watched) for case in cases]

    return Search(task.drive, [task.way], time, judge, lambda swings: max(map(goal.cost, swings)))


def _others(task: Task, time: float, goal: Goal, s_curve: Candidate) -> list[tuple[str, Drive, Swing]]:
    """The best of each other family, with its swing of the nominal reduced model."""
    found, search = [], _search(task, time, goal)
    for kind in KINDS:
        if kind != "S-curve":
            found += [(kind, one.drive, one.swings[0]) for one in search.best(kind, [s_curve.shares], count=2)]
    first = course_of(min(found, key=lambda one: goal.cost(one[2]))[1] if found else s_curve.drive, task.way)
    for average in AVERAGES:
        smoothing = average * slowest_bounce(task)
        drive = free_drive(task.drive, task.way, time, task.cases(), task.watched, goal, first, smoothing)
        if drive:
            found.append((FREE, drive, small_swing(task.case(), course_of(drive, task.way), task.watched)))
    return found


def _period(task: Task) -> float:
    """Longest natural period [s] of either side with the car at the destination."""
    return max(side_string(task.model, task.way.destination, side).period() for side in SIDES)


def _bound(task: Task, factors: Sequence[float]) -> dict[str, Any]:
    """Lower bound of the spectrum at each travel time, and of the travel time for each fraction of the present swing."""
    present, period = course_of(task.drive, task.way), _period(task)
    own = lower_bound.spectrum(present, period)
    least = [lower_bound.least_spectrum(task.drive, task.way, factor * present.duration, period) / own for factor in factors]
    times = [lower_bound.least_time(task.drive, task.way, present, period, share) for share in SAVED]
    return {
        "least": [one if np.isfinite(one) else None for one in least],
        "too_short": lower_bound.too_short(present.duration, period),
        "times": [one if np.isfinite(one) else None for one in times],
    }  # fmt: skip


def installed_case(case: Mapping[str, Any]) -> list[float]:
    """The swing [m] during and after one trip of a drive, by its FMUs: a case of a sweep."""
    model = validated(case["model"], "case")
    drive, way = Drive.model_validate(case["drive"]), Way(case["way"][0], case["way"][1], periods(model))
    swing = installed(model, case_of(model), drive, way, tail(model, way.destination)).swing()
    return [swing.during, swing.after]


def drive_of(task: Task, told: Mapping[str, Any]) -> Drive:
    """The drive of a result."""
    return Drive.model_validate(task.drive.model_dump() | told["drive"])


def _installed(task: Task, point: Mapping[str, Any]) -> dict[str, Any]:
    """Simulation of the present drive, the best S-curve and the tuned drive of a point with FMUs; traces for the figure."""
    drives = {"present": task.present, "s_curve": drive_of(task, point["s_curve"]), "tuned": drive_of(task, point["tuned"])}
    told = {}
    for name, drive in drives.items():
        trace = installed(task.model, task.case(), drive, task.way, task.watched)
        told[name] = _shown(task, trace, drive)
    return {"factor": point["factor"], **told}


def _shown(task: Task, trace: Trace, drive: Drive) -> dict[str, Any]:
    swing, course = trace.swing(), course_of(drive, task.way, 0.5)
    every = slice(None, None, 5)
    return {
        "swing": [swing.during, swing.after], "end": trace.end, "time": trace.time[every].tolist(),
        "largest": np.maximum.reduceat(trace.largest(), np.arange(0, len(trace.time), 5)).tolist(),
        "speed": [course.at(one).velocity for one in trace.time[every]],
        "acceleration": [course.at(one).acceleration for one in trace.time[every]],
    }  # fmt: skip


def _robust(task: Task, point: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Swings of the full model with the sheave 10 % lighter and heavier."""
    found = []
    for factor in (0.9, 1.1):
        model, case = heavier(task.model, factor), task.case(factor)
        row: dict[str, Any] = {"mass": factor}
        for name in ("s_curve", "tuned"):
            swing = installed(model, case, drive_of(task, point[name]), task.way, task.watched, direct=True).swing()
            row[name] = [swing.during, swing.after]
        found.append(row)
    return found
