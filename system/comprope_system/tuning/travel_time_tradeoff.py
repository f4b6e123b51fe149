"""Travel time needed for less residual vibration: the fastest trip with a given fraction of the present swing after it."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from comprope.drive.parameters import Drive

from ..vibration.reduced_model.swing import reduced_swing
from .search.profile_families import trajectory_of
from .search.trajectory_optimisation import Objective, optimised_drive
from .task import Task, evaluated

FREE = "free"
TARGET_SHARE = 0.95  # of a share is looked for
CORRECTIONS = 3  # times the reduced model is asked again, for as much less or more as the full model was off
MAX_TIME_FACTOR = 4.0  # of the shortest travel time


def least_times(task: Task, shares: Sequence[float], after: float) -> list[dict[str, Any]]:
    """Shortest travel time found for each fraction of the present swing `after` the trip [m], full model."""
    least_swing = _LeastSwing(task)
    return [_time_for(task, least_swing, share, after) for share in shares]


def take_faster(
    found: Sequence[Mapping[str, Any]], points: Sequence[Mapping[str, Any]], present: Mapping[str, Any]
) -> list[Mapping[str, Any]]:
    """The trip found for each fraction, or a faster one of the trade-off curve that meets it on the full model.

    `present` is the present trip; a trip that exceeds its fraction on the full model is replaced by any that does not.
    """
    candidates = [point[key] for point in points for key in ("s_curve", "tuned")]
    return [_fastest_of(one, candidates, one["share"] * present["full"][1]) for one in found]


def _fastest_of(found: Mapping[str, Any], others: Sequence[Mapping[str, Any]], most: float) -> Mapping[str, Any]:
    kept = [one for one in (found, *others) if one["full"] and one["full"][1] <= most]
    return {**min(kept, key=lambda one: one["time"]), "share": found["share"]} if kept else found


class _LeastSwing:
    """The drive with the least swing after a trip, as a function of the travel time, with the reduced model."""

    def __init__(self, task: Task) -> None:
        self.task, self.evaluated_factors = task, dict[float, tuple[Drive | None, float]]()
        self.present = trajectory_of(task.drive, task.route)
        own = reduced_swing(task.reduced_model(), self.present, task.observation)
        self.objective, self.after = Objective(0.05 / own.during, 0.95 / own.after), own.after

    def __call__(self, factor: float) -> tuple[Drive | None, float]:
        """The drive and its swing after the trip relative to the present one; infinite if no curve is so fast."""
        if factor not in self.evaluated_factors:
            task, case = self.task, self.task.reduced_model()
            near = min(
                ((abs(factor - one), drive) for one, (drive, _) in self.evaluated_factors.items() if drive),
                default=(0.0, None),
                key=_first,
            )[1]
            first = trajectory_of(near, task.route) if near else self.present
            time = factor * self.present.duration
            drive = optimised_drive(task.drive, task.route, time, [case], task.observation, self.objective, first)
            left = reduced_swing(case, trajectory_of(drive, task.route), task.observation).after / self.after if drive else np.inf
            self.evaluated_factors[factor] = drive, left
        return self.evaluated_factors[factor]


def _first(pair: tuple[float, Drive | None]) -> float:
    return pair[0]


def _time_for(task: Task, least_swing: _LeastSwing, share: float, after: float) -> dict[str, Any]:
    """The fastest trip found that meets the fraction on the full model; if none does, the last one evaluated.

    Searched with the reduced model, and again with a fraction corrected by the result of the full model.
    """
    found: list[dict[str, Any]] = []
    target = TARGET_SHARE * share
    for _ in range(CORRECTIONS):
        drive = _fastest(least_swing, target)
        if drive is None:
            break
        found.append(
            evaluated(task, drive, FREE, reduced_swing(task.reduced_model(), trajectory_of(drive, task.route), task.observation))
        )
        target *= TARGET_SHARE * share * after / found[-1]["full"][1]
    if not found:
        return {"share": share, "time": None, "small": None, "full": None}
    kept = [one for one in found if one["full"][1] <= share * after]
    return {"share": share} | (min(kept, key=lambda one: one["time"]) if kept else found[-1])


def _fastest(least_swing: _LeastSwing, target: float) -> Drive | None:
    """The drive of shortest travel time for the fraction `target` of the present swing, with the reduced model, by bisection."""
    low = high = 1.0
    while high < MAX_TIME_FACTOR and least_swing(high := 1.2 * high)[1] > target:
        low = high
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if least_swing(middle)[1] <= target else (middle, high)
    drive, left = least_swing(high)
    return drive if left <= target else None
