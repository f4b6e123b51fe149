"""One controller for all trips: the family of profiles, its parameters and the shaper's period for all trips together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from comprope.drive.parameters import Drive

from ..reduced_model.swing import Swing, small_swing
from .search.profile_families import KINDS, course_of
from .search.quasi_random_search import Candidate, Search
from .search.trajectory_optimisation import Goal
from .task import Task

KEPT = 1.0  # of its present swing: what no trip should pass


@dataclass(frozen=True)
class Joint:
    """The chosen drive, its family, travel times [s] and reduced-model swings by trip, and the cost of each family."""

    drive: Drive
    kind: str
    times: list[float]
    swings: list[Swing]
    costs: Mapping[str, float]


def joint(tasks: Sequence[Task], extra: float) -> Joint | None:
    """The drive with the least swing over all trips, with travel times increased by the fraction `extra` in total.

    None if no family is so fast.
    """
    present = [course_of(task.present, task.way) for task in tasks]
    time = (1.0 + extra) * sum(one.duration for one in present)
    cases = [task.case() for task in tasks]
    goals = []
    for task, case, course in zip(tasks, cases, present, strict=True):
        own = small_swing(case, course, task.watched)
        goals.append(Goal((1.0 - task.weight) / own.during, task.weight / own.after, Swing(KEPT * own.during, KEPT * own.after)))

    def judge(drive: Drive) -> list[Swing]:
        return [small_swing(case, course_of(drive, task.way), task.watched) for task, case in zip(tasks, cases, strict=True)]

    def cost(swings: list[Swing]) -> float:
        return float(np.mean([goal.cost(one) for goal, one in zip(goals, swings, strict=True)]))

    search = Search(tasks[0].drive, [task.way for task in tasks], time, judge, cost)
    found: list[Candidate] = []
    for kind in KINDS:
        found += search.best(kind, [found[0].shares] if found else [])
    if not found:
        return None
    best = min(found, key=lambda one: one.cost)
    times = [course_of(best.drive, task.way).duration for task in tasks]
    return Joint(best.drive, best.kind, times, best.swings, {one.kind: one.cost for one in found})


def told(found: Joint, full: Sequence[Any]) -> dict[str, Any]:
    """The result for JSON, with the swings simulated by the FMUs."""
    return {
        "kind": found.kind, "times": found.times, "costs": dict(found.costs),
        "small": [[one.during, one.after] for one in found.swings], "full": list(full),
    }  # fmt: skip
