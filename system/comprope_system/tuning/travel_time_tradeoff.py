"""Travel time needed for less residual vibration: the fastest trip with a given fraction of the present swing after it."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from comprope.drive.parameters import Drive

from ..reduced_model.swing import small_swing
from .search.profile_families import course_of
from .search.trajectory_optimisation import Goal, free_drive
from .task import Task, told_of

FREE = "free"
AIM = 0.95  # of a share is looked for
CORRECTIONS = 3  # times the small rope is asked again, for as much less or more as the full model was off
LONGEST = 4.0  # of the shortest travel time


def saved(task: Task, shares: Sequence[float], after: float) -> list[dict[str, Any]]:
    """Shortest travel time found for each fraction of the present swing `after` the trip [m], full model."""
    quietest = _Quietest(task)
    return [_time_for(task, quietest, share, after) for share in shares]


def sooner(
    found: Sequence[Mapping[str, Any]], points: Sequence[Mapping[str, Any]], present: Mapping[str, Any]
) -> list[Mapping[str, Any]]:
    """The trip found for each fraction, or a faster one of the trade-off curve that meets it on the full model.

    `present` is the present trip; a trip that exceeds its fraction on the full model is replaced by any that does not.
    """
    told = [point[key] for point in points for key in ("s_curve", "tuned")]
    return [_soonest(one, told, one["share"] * present["full"][1]) for one in found]


def _soonest(found: Mapping[str, Any], others: Sequence[Mapping[str, Any]], most: float) -> Mapping[str, Any]:
    kept = [one for one in (found, *others) if one["full"] and one["full"][1] <= most]
    return {**min(kept, key=lambda one: one["time"]), "share": found["share"]} if kept else found


class _Quietest:
    """The drive with the least swing after a trip, as a function of the travel time, with the reduced model."""

    def __init__(self, task: Task) -> None:
        self.task, self.known = task, dict[float, tuple[Drive | None, float]]()
        self.present = course_of(task.drive, task.way)
        own = small_swing(task.case(), self.present, task.watched)
        self.goal, self.after = Goal(0.05 / own.during, 0.95 / own.after), own.after

    def __call__(self, factor: float) -> tuple[Drive | None, float]:
        """The drive and its swing after the trip relative to the present one; infinite if no curve is so fast."""
        if factor not in self.known:
            task, case = self.task, self.task.case()
            near = min(
                ((abs(factor - one), drive) for one, (drive, _) in self.known.items() if drive), default=(0.0, None), key=_first
            )[1]
            first = course_of(near, task.way) if near else self.present
            time = factor * self.present.duration
            drive = free_drive(task.drive, task.way, time, [case], task.watched, self.goal, first)
            left = small_swing(case, course_of(drive, task.way), task.watched).after / self.after if drive else np.inf
            self.known[factor] = drive, left
        return self.known[factor]


def _first(pair: tuple[float, Drive | None]) -> float:
    return pair[0]


def _time_for(task: Task, quietest: _Quietest, share: float, after: float) -> dict[str, Any]:
    """The fastest trip found that meets the fraction on the full model; if none does, the last one evaluated.

    Searched with the reduced model, and again with a fraction corrected by the result of the full model.
    """
    found: list[dict[str, Any]] = []
    asked = AIM * share
    for _ in range(CORRECTIONS):
        drive = _fastest(quietest, asked)
        if drive is None:
            break
        found.append(told_of(task, drive, FREE, small_swing(task.case(), course_of(drive, task.way), task.watched)))
        asked *= AIM * share * after / found[-1]["full"][1]
    if not found:
        return {"share": share, "time": None, "small": None, "full": None}
    kept = [one for one in found if one["full"][1] <= share * after]
    return {"share": share} | (min(kept, key=lambda one: one["time"]) if kept else found[-1])


def _fastest(quietest: _Quietest, asked: float) -> Drive | None:
    """The drive of shortest travel time for the fraction `asked` of the present swing, with the reduced model, by bisection."""
    low = high = 1.0
    while high < LONGEST and quietest(high := 1.2 * high)[1] > asked:
        low = high
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if quietest(middle)[1] <= asked else (middle, high)
    drive, left = quietest(high)
    return drive if left <= asked else None
