"""The tuning of one trip: for each travel time the best S-curve and the best of all other trips, judged on the full model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from comprope.drive.parameters import Drive, FirstTrip
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.modelfile import as_table, validated, with_changes

from ..hanging import side_string
from . import bound
from .bounce import Hoist, hoist_of
from .calibrate import calibrated
from .families import KINDS, Way, course_of
from .free import Goal, free_drive
from .installed import Trace, installed
from .measure import SIDES, Case, Swing, small_swing, tail
from .search import Candidate, Search

BETTER = 0.97  # of the S-curve's swings: what a tuned trip is asked to stay under in both
SAVED = (0.5, 0.2)  # of the swing after the fastest trip: what time these take
ASKED = 0.9  # of a share is looked for on the small rope, which does not know the sheave's bounce
AVERAGES = (0.0, 0.5)  # of the slowest bounce: moving averages that trips of a free shape are tried with
OTHERS = 3  # other trips, likewise
CURVES = 4  # S-curves, unlike each other, that are judged on the full model
LONGEST = 4.0  # of the shortest travel time
FREE = "free"
CHOSEN = {"profile", "curve", "shaper", "servo"}


@dataclass(frozen=True)
class Task:
    """One trip to tune: model, drive with the gains to use and the present one, the way, travel times over the shortest one, the weight of the swing after the trip,
    the spread of the sheave's mass to be prepared for, and which of the times is installed and shown: the one nearest to
    `chosen`, or the shortest that swings less than `limit` [m] if there is one."""

    model: RopeModel
    drive: Drive
    present: Drive
    way: Way
    factors: Sequence[float]
    weight: float
    spread: float
    chosen: float
    limit: float | None = None

    @property
    def watched(self) -> float:
        """How long [s] to watch after the trip."""
        return tail(self.model, self.way.destination)

    @property
    def hoist(self) -> Hoist:
        """The bounces of car and counterweight under the present servo."""
        return hoist_of(Drive(shaft=self.drive.shaft, plant=self.drive.plant, servo=self.drive.servo, trip=FirstTrip(destination=0.0)))

    def case(self, mass: float = 1.0) -> Case:
        """The small rope with the sheave's mass times `mass`."""
        model = heavier(self.model, mass)
        return Case(calibrated(model), model.shaft.height, model.shaft.pit, self.hoist)

    def cases(self) -> list[Case]:
        """The ropes that the search judges by."""
        return [self.case()] + [self.case(1.0 + sign * self.spread) for sign in (-1.0, 1.0) if self.spread]


def heavier(model: RopeModel, factor: float) -> RopeModel:
    """The model with the sheave's mass and inertia times a factor."""
    sheave = model.sheave
    if factor == 1.0:
        return model
    return with_changes(model, {"sheave.mass": sheave.mass * factor, "sheave.inertia": sheave.inertia * factor}, "sheave")


def periods(model: RopeModel) -> tuple[float, float]:
    """The rope's slowest period [s] with the car at a terminal landing and half-way up."""
    height = model.shaft.height
    return side_string(model, 0.0).period(), side_string(model, 0.5 * height).period()


def as_case(task: Task) -> dict[str, Any]:
    """The task as a case of a sweep."""
    return {
        "model": as_table(task.model), "drive": task.drive.model_dump(), "present": task.present.model_dump(),
        "way": [task.way.origin, task.way.destination],
        "factors": list(task.factors), "weight": task.weight, "spread": task.spread, "chosen": task.chosen, "limit": task.limit,
    }  # fmt: skip


def tuned_trip(case: Mapping[str, Any]) -> dict[str, Any]:
    """`tuning` as a case of a sweep."""
    model = validated(case["model"], "case")
    way = Way(*case["way"], periods(model))
    drive, present = (Drive.model_validate(case[name]) for name in ("drive", "present"))
    return tuning(Task(model, drive, present, way, case["factors"], case["weight"], case["spread"], case["chosen"], case["limit"]))


def tuning(task: Task) -> dict[str, Any]:
    """Everything found about a trip, as JSON holds it: times in s, swings in m as [during, after]."""
    present = course_of(task.drive, task.way)
    own = small_swing(task.case(), present, task.watched)
    if own.after <= 0.0 or own.during <= 0.0:
        raise InputError(f"trip of {task.way.distance:g} m: the rope does not swing; there is nothing to tune")
    goal = Goal((1.0 - task.weight) / own.during, task.weight / own.after)
    points = [point for factor in task.factors if (point := _point(task, factor, goal))]
    chosen = _chosen(task, points)
    return {
        "origin": task.way.origin, "destination": task.way.destination,
        "present": _told(task, task.present, "present", own), "points": points,
        "period": _period(task), "bound": _bound(task, [one["factor"] for one in points]), "saved": _saved(task),
        "installed": _installed(task, chosen) if chosen else None,
        "robust": _robust(task, chosen) if chosen else None,
    }  # fmt: skip


def _chosen(task: Task, points: Sequence[dict[str, Any]]) -> dict[str, Any] | None:
    """The point that is installed; None where a limit is not met, or there is no point."""
    if task.limit is not None:
        return next((one for one in points if max(one["tuned"]["full"]) <= task.limit), None)
    return min(points, key=lambda one: abs(one["factor"] - task.chosen), default=None)


def _told(task: Task, drive: Drive, kind: str, small: Swing) -> dict[str, Any]:
    """A drive with its travel time and its swings on the small rope and on the full model."""
    course = course_of(drive, task.way)
    full = installed(task.model, task.case(), drive, task.way, task.watched, direct=True).swing()
    return {
        "kind": kind, "time": course.duration, "drive": drive.model_dump(include=CHOSEN),
        "small": [small.during, small.after], "full": [full.during, full.after],
    }  # fmt: skip


def _point(task: Task, factor: float, goal: Goal) -> dict[str, Any] | None:
    """The best S-curve and the best other trip of a travel time; None where no other is so fast."""
    time = factor * course_of(task.drive, task.way).duration
    search = _search(task, time, goal)
    curves = search.best("S-curve", count=CURVES)
    if not curves:
        return None
    cost = _full_cost(goal)
    s_curve = min((_told(task, one.drive, "S-curve", one.swings[0]) for one in curves), key=cost)
    stricter = Goal(goal.during, goal.after, Swing(BETTER * curves[0].swings[0].during, BETTER * curves[0].swings[0].after))
    others = _others(task, time, stricter, curves[0])
    tried = {kind: [swing.during, swing.after] for kind, _, swing in others}
    best = sorted(others, key=lambda one: stricter.cost(one[2]))[:OTHERS]
    told = [_told(task, drive, kind, swing) for kind, drive, swing in best]
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
    """The best of each other kind, with its swing on the nominal small rope."""
    found, search = [], _search(task, time, goal)
    for kind in KINDS:
        if kind != "S-curve" and (best := search.best(kind, [s_curve.shares])):
            found.append((kind, best[0].drive, best[0].swings[0]))
    first = course_of(min(found, key=lambda one: goal.cost(one[2]))[1] if found else s_curve.drive, task.way)
    for average in AVERAGES:
        smoothing = average * _bounce(task)
        drive = free_drive(task.drive, task.way, time, task.cases(), task.watched, goal, first, smoothing)
        if drive:
            found.append((FREE, drive, small_swing(task.case(), course_of(drive, task.way), task.watched)))
    return found


def _bounce(task: Task) -> float:
    """The slowest bounce [s] on the way."""
    return max(task.hoist.period(height) for height in (task.way.origin, task.way.destination))


def _period(task: Task) -> float:
    """The slowest period [s] of either side with the car at the destination."""
    return max(side_string(task.model, task.way.destination, side).period() for side in SIDES)


def _bound(task: Task, factors: Sequence[float]) -> dict[str, Any]:
    """The least that the spectrum allows at each travel time, and the least time for each share of the present swing."""
    present, period = course_of(task.drive, task.way), _period(task)
    own = bound.spectrum(present, period)
    least = [bound.least_spectrum(task.drive, task.way, factor * present.duration, period) / own for factor in factors]
    times = [bound.least_time(task.drive, task.way, present, period, share) for share in SAVED]
    return {
        "least": [one if np.isfinite(one) else None for one in least], "too_short": bound.too_short(present.duration, period),
        "times": [one if np.isfinite(one) else None for one in times],
    }  # fmt: skip


def _saved(task: Task) -> list[dict[str, Any]]:
    """The least travel time found that leaves each share of SAVED of the present swing after the trip, full model."""
    quietest = _Quietest(task)
    return [_time_for(task, quietest, share) for share in SAVED]


class _Quietest:
    """The drive that leaves least swing after a trip of some factor of the present travel time, on the small rope."""

    def __init__(self, task: Task) -> None:
        self.task, self.known = task, dict[float, tuple[Drive | None, float]]()
        self.present = course_of(task.drive, task.way)
        own = small_swing(task.case(), self.present, task.watched)
        self.goal, self.after = Goal(0.05 / own.during, 0.95 / own.after), own.after

    def __call__(self, factor: float) -> tuple[Drive | None, float]:
        """The drive and its swing after the trip over the present one's; infinite where no curve is so fast."""
        if factor not in self.known:
            task, case = self.task, self.task.case()
            near = min(((abs(factor - one), drive) for one, (drive, _) in self.known.items() if drive), default=(0.0, None), key=_first)[1]
            first = course_of(near, task.way) if near else self.present
            time = factor * self.present.duration
            drive = free_drive(task.drive, task.way, time, [case], task.watched, self.goal, first)
            left = small_swing(case, course_of(drive, task.way), task.watched).after / self.after if drive else np.inf
            self.known[factor] = drive, left
        return self.known[factor]


def _first(pair: tuple[float, Drive | None]) -> float:
    return pair[0]


def _time_for(task: Task, quietest: _Quietest, share: float) -> dict[str, Any]:
    """By bisection over travel times on the small rope, asked for a little less than the share; judged on the full model."""
    low = high = 1.0
    while high < LONGEST and quietest(high := 1.2 * high)[1] > ASKED * share:
        low = high
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if quietest(middle)[1] <= ASKED * share else (middle, high)
    drive, left = quietest(high)
    if drive is None or left > ASKED * share:
        return {"share": share, "time": None, "small": None, "full": None}
    return {"share": share} | _told(task, drive, FREE, small_swing(task.case(), course_of(drive, task.way), task.watched))


def installed_case(case: Mapping[str, Any]) -> list[float]:
    """The swing [m] during and after one trip of a drive, by its FMUs: a case of a sweep."""
    model = validated(case["model"], "case")
    drive, way = Drive.model_validate(case["drive"]), Way(*case["way"], periods(model))
    rope = Case(calibrated(model), model.shaft.height, model.shaft.pit)
    swing = installed(model, rope, drive, way, tail(model, way.destination)).swing()
    return [swing.during, swing.after]


def drive_of(task: Task, told: Mapping[str, Any]) -> Drive:
    """The drive of a result."""
    return Drive.model_validate(task.drive.model_dump() | told["drive"])


def _installed(task: Task, point: Mapping[str, Any]) -> dict[str, Any]:
    """The present drive, the best S-curve and the tuned drive of a point as FMUs with the rope's FMU; traces for the picture."""
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
    """Swings on the full model with the sheave a tenth lighter and heavier."""
    found = []
    for factor in (0.9, 1.1):
        model, case = heavier(task.model, factor), task.case(factor)
        row: dict[str, Any] = {"mass": factor}
        for name in ("s_curve", "tuned"):
            swing = installed(model, case, drive_of(task, point[name]), task.way, task.watched, direct=True).swing()
            row[name] = [swing.during, swing.after]
        found.append(row)
    return found
