"""One controller for all trips: the family of profiles, its parameters and the shaper's period for all trips together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from comprope.drive.parameters import Drive

from ..vibration.reduced_model.swing import Swing, reduced_swing
from .search.profile_families import KINDS, trajectory_of
from .search.quasi_random_search import Candidate, Search
from .search.trajectory_optimisation import Objective
from .task import Task

CAP_SHARE = 1.0  # of its present swing: what no trip should pass


@dataclass(frozen=True)
class SharedController:
    """The chosen drive, its family, travel times [s] and reduced-model swings by trip, and the cost of each family."""

    drive: Drive
    kind: str
    times: list[float]
    swings: list[Swing]
    costs: Mapping[str, float]


def shared_controller(tasks: Sequence[Task], extra: float) -> SharedController | None:
    """The drive with the least swing over all trips, with travel times increased by the fraction `extra` in total.

    None if no family is so fast.
    """
    present = [trajectory_of(task.present, task.route) for task in tasks]
    time = (1.0 + extra) * sum(one.duration for one in present)
    models = [task.reduced_model() for task in tasks]
    objectives = []
    for task, reduced, trajectory in zip(tasks, models, present, strict=True):
        own = reduced_swing(reduced, trajectory, task.observation)
        objectives.append(
            Objective(
                (1.0 - task.weight) / own.during, task.weight / own.after, Swing(CAP_SHARE * own.during, CAP_SHARE * own.after)
            )
        )

    def evaluate(drive: Drive) -> list[Swing]:
        return [
            reduced_swing(reduced, trajectory_of(drive, task.route), task.observation)
            for task, reduced in zip(tasks, models, strict=True)
        ]

    def cost(swings: list[Swing]) -> float:
        return float(np.mean([objective.cost(one) for objective, one in zip(objectives, swings, strict=True)]))

    search = Search(tasks[0].drive, [task.route for task in tasks], time, evaluate, cost)
    found: list[Candidate] = []
    for kind in KINDS:
        found += search.best(kind, [found[0].shares] if found else [])
    if not found:
        return None
    best = min(found, key=lambda one: one.cost)
    times = [trajectory_of(best.drive, task.route).duration for task in tasks]
    return SharedController(best.drive, best.kind, times, best.swings, {one.kind: one.cost for one in found})


def shared_controller_json(found: SharedController, full: Sequence[Any]) -> dict[str, Any]:
    """The result for JSON, with the swings simulated by the FMUs."""
    return {
        "kind": found.kind, "times": found.times, "costs": dict(found.costs),
        "small": [[one.during, one.after] for one in found.swings], "full": list(full),
    }  # fmt: skip
