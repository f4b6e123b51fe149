"""Points in the space of fitted parameters, and the predictions of runs there."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field, replace
from math import exp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel
from comprope.rope.parameters.parameter_vector import DECLARED
from comprope.rope.simulator.rope import values_of

from ..data.campaign import Campaign
from ..data.runs import Channel, Run
from ..settings import REPLAY
from .plant_parameters import CLOCK, PLANT_PARAMETERS
from .replay import replay

Floats = NDArray[np.float64]
Predictions = dict[tuple[str, str], Floats]


@dataclass(frozen=True)
class ParameterPoint:
    """Coefficients of plant parameters by name (0: as in the model file), and parameters of effects by model key.

    `shifts` are added to parameters of effects in single runs, by the run's file.
    """

    plant: Mapping[str, float] = field(default_factory=dict)
    effects: Mapping[str, float] = field(default_factory=dict)
    shifts: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def changes(self, model: RopeModel, run: Run) -> dict[str, Any]:
        """Parameters that differ from the model file in a run at this point, by model key."""
        base = values_of(model) | {key: value for key, value in run.changes.items() if isinstance(value, (int, float))}
        changed: dict[str, Any] = dict(run.changes) | dict(self.effects)
        for key, shift in self.shifts.get(run.file, {}).items():
            changed[key] = changed.get(key, base.get(key, 0.0)) + shift
        if offset := self.plant.get(CLOCK, 0.0):
            known = model.effects.sensor_delay or {}
            keys = {f"effects.sensor_delay.{column}": known.get(column, 0.0) for column in run.values}
            changed |= {key: changed.get(key, delay) + offset for key, delay in keys.items()}
        for one in PLANT_PARAMETERS:
            if (coefficient := self.plant.get(one.name, 0.0)) and one.changes:
                value = base[one.name] * exp(coefficient) if one.relative else base[one.name] + coefficient
                # A fit may drive a parameter without influence to its bounds; the model must still accept it.
                changed[one.name] = min(max(value, DECLARED[one.name].minimum), DECLARED[one.name].maximum)
        return changed


def submit_replays(
    campaign: Campaign, runs: Sequence[Run], point: ParameterPoint, executor: Executor, coarse: float = 1.0
) -> list[Future[dict[str, Floats]]]:
    """Start the replays of some runs at a point, with elements and time steps `coarse` times as long."""
    there = [run_at_point(campaign.model, run, point, coarse) for run in runs]
    return [executor.submit(predict, campaign.model, run, campaign.channels, coarse * REPLAY.time_step) for run in there]


def run_at_point(model: RopeModel, run: Run, point: ParameterPoint, coarse: float = 1.0) -> Run:
    """The run with the changes of a point, and with elements `coarse` times as long."""
    length = {"rope.element_length": coarse * model.rope.element_length} if coarse != 1.0 else {}
    return replace(run, changes=point.changes(model, run) | length)


def predict(model: RopeModel, run: Run, channels: Mapping[str, Channel], step: float) -> dict[str, Floats]:
    """Simulated channels (n,) [SI] of one run, by column."""
    return replay(model, run, channels, step).values


def collect_predictions(runs: Sequence[Run], jobs: Sequence[Future[dict[str, Floats]]]) -> Predictions:
    """Predictions of runs by (file, column), when their replays are done."""
    return {(run.file, column): value for run, job in zip(runs, jobs, strict=True) for column, value in job.result().items()}
