"""The model driven by a measured run: what each channel should have shown."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from comprope.rope.effects import RopeModel
from comprope.rope.model_file import with_changes
from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope

from ..data.campaign import Channel, Run
from ..settings import REPLAY

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Replay:
    """Channels of a run as the model has them: `values[column]` (n,) in SI units, NaN where the rope is not in view."""

    values: dict[str, Floats]
    newton_iterations: int
    halvings: int


def replay(model: RopeModel, run: Run, channels: Mapping[str, Channel], step: float = REPLAY.time_step) -> Replay:
    """Drive the model, with the run's changes, by the run's trip; references to rest are taken as in the data."""
    changed = with_changes(model, run.changes | {"solver.step": step}, run.file)
    rope = CompensationRope(changed)
    grid = run.time[0] + REPLAY.output_interval * np.arange(
        int(np.ceil((run.time[-1] - run.time[0]) / REPLAY.output_interval)) + 2
    )
    seen = _drive(rope, run, grid, channels)
    values = {}
    for column in channels:
        whole = CubicSpline(grid, seen[column][:, 0])(run.time)
        hidden = np.interp(run.time, grid, seen[column][:, 1]) < 1.0
        values[column] = np.where(hidden, np.nan, whole)
    shown = {column: instrument(changed, column, run.time, value) for column, value in values.items()}
    return Replay(relative_to_rest(shown, run, channels), rope.count["newton"], rope.count["halved"])


def coarsening_factor(model: RopeModel) -> float:
    """How much longer elements may be for a first look: twice, where that still bends round the sheave."""
    coarse = REPLAY.coarsening
    return coarse if coarse * model.rope.element_length <= REPLAY.coarse_element * model.sheave.radius else 1.0


def instrument(model: RopeModel, column: str, time: Floats, value: Floats) -> Floats:
    """What a channel's instrument makes of the true value: delayed, with its gain, from its offset, which may drift."""
    gain, offset, delay, drift = (
        (getattr(model.effects, name) or {}).get(column)
        for name in ("sensor_gain", "sensor_offset", "sensor_delay", "sensor_drift")
    )
    late = _delayed(time, value, delay) if delay else value
    return (1.0 if gain is None else gain) * late + (offset or 0.0) + (drift or 0.0) * (time - time[0])


def _delayed(time: Floats, value: Floats, delay: float) -> Floats:
    """The value a while ago; what is not in view stays so, and hides nothing of what is."""
    known = np.isfinite(value)
    if not known.any():
        return value
    return np.where(known, np.interp(time - delay, time[known], value[known]), np.nan)


def relative_to_rest(values: dict[str, Floats], run: Run, channels: Mapping[str, Channel]) -> dict[str, Floats]:
    """Values less their mean before the trip, where the channel counts from rest."""
    rest = run.rest
    return {
        column: value - np.nanmean(value[rest])
        if channels[column].reference == "rest" and np.isfinite(value[rest]).any()
        else value
        for column, value in values.items()
    }


def _drive(rope: CompensationRope, run: Run, grid: Floats, channels: Mapping[str, Channel]) -> dict[str, Floats]:
    paths = _paths(rope.model, run, grid)
    rope.solve_equilibrium(-paths[0, 0, 0], -paths[0, 2, 0], time=float(grid[0]))
    seen = {column: np.ones((len(grid), 2)) for column in channels}
    sensors = {sensor.name: sensor for sensor in rope.model.sensors}
    evaluated = any(one.quantity.endswith(("force", "tension")) for one in channels.values())
    for k in range(len(grid)):
        if k:
            rope.step(REPLAY.output_interval, np.concatenate([paths[k - 1], paths[k]], axis=1).ravel())
        outputs: Mapping[str, Any] = rope.outputs() if evaluated else rope.sheave()
        for column, channel in channels.items():
            if channel.quantity == "lateral_displacement":
                sensor = sensors[str(channel.sensor)]
                seen[column][k] = rope.lateral_displacement(sensor.side, sensor.height)
            else:
                seen[column][k, 0] = outputs[channel.quantity]
    return seen


def _paths(model: Base, run: Run, grid: Floats) -> Floats:
    """Position, velocity and acceleration of the four coordinates of the ends at the grid's times: (times, 4, 3)."""
    paths = np.zeros((len(grid), 4, 3))
    for k, trip in ((0, run.trip), (2, run.counterweight)):
        paths[:, k] = -np.column_stack([trip.position(grid), trip.velocity(grid), trip.acceleration(grid)])
    paths[:, 1, 0], paths[:, 3, 0] = -model.sheave.radius, model.sheave.radius
    return paths
