"""Replay of a measured run: the channels that the model predicts when its ends move as measured."""

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
    """Simulated channels of a run: `values[column]` (n,) [SI], NaN where the rope is out of the sensor's view."""

    values: dict[str, Floats]
    newton_iterations: int
    halvings: int


def replay(model: RopeModel, run: Run, channels: Mapping[str, Channel], step: float = REPLAY.time_step) -> Replay:
    """Simulate a run with its parameters and its trip; channels are relative to rest where the measured ones are."""
    changed = with_changes(model, run.changes | {"solver.step": step}, run.file)
    rope = CompensationRope(changed)
    grid = output_times(run)
    channels_on_grid = _simulated_channels(rope, run, grid, channels)
    values = {}
    for column in channels:
        value = CubicSpline(grid, channels_on_grid[column][:, 0])(run.time)
        hidden = np.interp(run.time, grid, channels_on_grid[column][:, 1]) < 1.0
        values[column] = np.where(hidden, np.nan, value)
    shown = {column: instrument(changed, column, run.time, value) for column, value in values.items()}
    return Replay(relative_to_rest(shown, run, channels), rope.count["newton"], rope.count["halved"])


def coarsening_factor(model: RopeModel) -> float:
    """Factor of element length and time step in screening; 1 where longer elements could not follow the sheave's groove."""
    coarse = REPLAY.coarsening
    return coarse if coarse * model.rope.element_length <= REPLAY.coarse_element * model.sheave.radius else 1.0


def instrument(model: RopeModel, column: str, time: Floats, value: Floats) -> Floats:
    """Channel (n,) as its instrument shows it: gain * value(t - delay) + offset + drift * (t - t_0)."""
    gain, offset, delay, drift = (
        (getattr(model.effects, name) or {}).get(column)
        for name in ("sensor_gain", "sensor_offset", "sensor_delay", "sensor_drift")
    )
    late = _delayed(time, value, delay) if delay else value
    return (1.0 if gain is None else gain) * late + (offset or 0.0) + (drift or 0.0) * (time - time[0])


def _delayed(time: Floats, value: Floats, delay: float) -> Floats:
    """Value (n,) a `delay` [s] earlier, by linear interpolation; samples out of view stay so and hide no others."""
    known = np.isfinite(value)
    if not known.any():
        return value
    return np.where(known, np.interp(time - delay, time[known], value[known]), np.nan)


def relative_to_rest(values: dict[str, Floats], run: Run, channels: Mapping[str, Channel]) -> dict[str, Floats]:
    """Channels (n,), less their mean at rest before the trip where the channel's reference is "rest"."""
    rest = run.rest
    return {
        column: value - np.nanmean(value[rest])
        if channels[column].reference == "rest" and np.isfinite(value[rest]).any()
        else value
        for column, value in values.items()
    }


def output_times(run: Run) -> Floats:
    """Times [s] of the outputs of a replay, from the start of the record to just beyond its end."""
    count = int(np.ceil((run.time[-1] - run.time[0]) / REPLAY.output_interval)) + 2
    return np.asarray(run.time[0] + REPLAY.output_interval * np.arange(count))


def _simulated_channels(rope: CompensationRope, run: Run, grid: Floats, channels: Mapping[str, Channel]) -> dict[str, Floats]:
    """Value of each channel [SI] and whether it is in view (1 or 0) at the times of the grid: (times, 2)."""
    motion = end_motion(rope.model, run, grid)
    rope.solve_equilibrium(-motion[0, 0, 0], -motion[0, 2, 0], time=float(grid[0]))
    found = {column: np.ones((len(grid), 2)) for column in channels}
    sensors = {sensor.name: sensor for sensor in rope.model.sensors}
    with_forces = any(one.quantity.endswith(("force", "tension")) for one in channels.values())
    for k in range(len(grid)):
        if k:
            rope.step(REPLAY.output_interval, np.concatenate([motion[k - 1], motion[k]], axis=1).ravel())
        outputs: Mapping[str, Any] = rope.outputs() if with_forces else rope.sheave()
        for column, channel in channels.items():
            if channel.quantity == "lateral_displacement":
                sensor = sensors[str(channel.sensor)]
                found[column][k] = rope.lateral_displacement(sensor.side, sensor.height)
            else:
                found[column][k, 0] = outputs[channel.quantity]
    return found


def end_motion(model: Base, run: Run, grid: Floats) -> Floats:
    """Position, velocity and acceleration of the four coordinates of the rope's ends: (times, 4, 3) [SI]."""
    motion = np.zeros((len(grid), 4, 3))
    for k, trip in ((0, run.trip), (2, run.counterweight)):
        motion[:, k] = -np.column_stack([trip.position(grid), trip.velocity(grid), trip.acceleration(grid)])
    motion[:, 1, 0], motion[:, 3, 0] = -model.sheave.radius, model.sheave.radius
    return motion
