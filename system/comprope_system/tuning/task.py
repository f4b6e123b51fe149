"""Definition of one trip to tune, and the evaluation of a drive on it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from comprope.drive.parameters import Drive
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table, with_changes

from ..presets.paper_installations import sheave_changes
from ..vibration.modal.hanging_string import side_string
from ..vibration.reduced_model.calibration import calibrated_string
from ..vibration.reduced_model.hoist_bounce import HoistBounce, hoist_bounce
from ..vibration.reduced_model.swing import ReducedModel, Swing, observation_time
from .fmu_validation import simulate_route
from .search.profile_families import Route, trajectory_of

TUNED_PARTS = {"profile", "curve", "shaper", "servo"}  # parts of the drive that a tuning chooses


@dataclass(frozen=True)
class Task:
    """One trip to tune.

    Model, drive with the gains to use and the present one, the way, travel times over the shortest one, the weight of the swing
    after the trip, the range of the sheave's mass to consider, and which of the times is validated with FMUs and shown: the one
    closest to `chosen`, or the shortest with a swing below `limit` [m] if there is one.
    """

    model: RopeModel
    drive: Drive
    present: Drive
    route: Route
    factors: Sequence[float]
    weight: float
    spread: float
    chosen: float
    limit: float | None = None

    @property
    def observation(self) -> float:
        """Time [s] after the trip over which the swing is evaluated."""
        return observation_time(self.model, self.route.destination)

    @property
    def hoist(self) -> HoistBounce:
        """Vertical vibration of car and counterweight with the present servo."""
        return hoist_bounce(self.drive)

    def reduced_model(self, mass: float = 1.0) -> ReducedModel:
        """Reduced model with the sheave's mass multiplied by `mass`."""
        return reduced_model_of(with_sheave_factor(self.model, mass), self.hoist)

    def reduced_models(self) -> list[ReducedModel]:
        """The ropes for which the search evaluates a drive."""
        return [self.reduced_model()] + [self.reduced_model(1.0 + sign * self.spread) for sign in (-1.0, 1.0) if self.spread]


def reduced_model_of(model: RopeModel, hoist: HoistBounce | None = None) -> ReducedModel:
    """Reduced model of the rope in its shaft."""
    return ReducedModel(calibrated_string(model), model.shaft.height, model.shaft.pit, hoist)


def with_sheave_factor(model: RopeModel, factor: float) -> RopeModel:
    """The model with mass and inertia of the sheave multiplied by a factor."""
    return model if factor == 1.0 else with_changes(model, sheave_changes(model, model.sheave.mass * factor), "sheave")


def periods(model: RopeModel) -> tuple[float, float]:
    """Longest natural period [s] of the rope with the car at a terminal landing and at mid-height."""
    height = model.shaft.height
    return side_string(model, 0.0).period(), side_string(model, 0.5 * height).period()


def as_case(task: Task) -> dict[str, Any]:
    """The task as a case of a sweep."""
    return {
        "model": as_table(task.model), "drive": task.drive.model_dump(), "present": task.present.model_dump(),
        "way": [task.route.origin, task.route.destination],
        "factors": list(task.factors), "weight": task.weight, "spread": task.spread, "chosen": task.chosen, "limit": task.limit,
    }  # fmt: skip


def evaluated(task: Task, drive: Drive, kind: str, reduced: Swing) -> dict[str, Any]:
    """A drive with its travel time and its swings with the reduced and the full model."""
    trajectory = trajectory_of(drive, task.route)
    full = simulate_route(task.model, task.reduced_model(), drive, task.route, task.observation, direct=True).swing()
    return {
        "kind": kind, "time": trajectory.duration, "drive": drive.model_dump(include=TUNED_PARTS),
        "small": [reduced.during, reduced.after], "full": [full.during, full.after],
    }  # fmt: skip


def slowest_bounce(task: Task) -> float:
    """Longest period of the vertical vibration of the car during the trip [s]."""
    return max(task.hoist.period(height) for height in (task.route.origin, task.route.destination))
