"""Replay of a measured run: the channels that the model predicts when its ends move as measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from comprope.rope.effects import RopeModel
from comprope.rope.model_file import with_changes
from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope

from ...measurements import Trip
from ..data.runs import Channel, Run
from ..settings import REPLAY

Floats = NDArray[np.float64]
Side = Literal["car", "counterweight"]


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
    grid = output_times(run, step)
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
    late = delayed(time, value, delay) if delay else value
    return (1.0 if gain is None else gain) * late + (offset or 0.0) + (drift or 0.0) * (time - time[0])


def delayed(time: Floats, value: Floats, delay: float) -> Floats:
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


def output_interval(step: float) -> float:
    """Time between outputs [s] of a replay with a time step [s]."""
    return max(REPLAY.output_interval, REPLAY.output_steps * step)


def output_times(run: Run, step: float) -> Floats:
    """Times [s] of the outputs of a replay, from the start of the record, or of a run-up before it, to just beyond its end."""
    begin, run_up = run.time[0], max(0.0, run.time[0] - run.trip.rest_before)
    interval = output_interval(step)
    first, count = -int(np.ceil(run_up / interval)), int(np.ceil((run.time[-1] - begin) / interval)) + 2
    return np.asarray(begin + interval * np.arange(first, count))


def _simulated_channels(rope: CompensationRope, run: Run, grid: Floats, channels: Mapping[str, Channel]) -> dict[str, Floats]:
    """Value of each channel [SI] and whether it is in view (1 or 0) at the times of the grid: (times, 2)."""
    motion = end_motion(rope.model, run, grid)
    rope.solve_equilibrium(*start_of(rope.model, motion), time=float(grid[0]))
    found = {column: np.ones((len(grid), 2)) for column in channels}
    with_forces = any(one.quantity.endswith(("force", "tension")) for one in channels.values())
    paths = interval_paths(motion)
    lateral = watched_heights(rope.model, channels)
    others = {column: one.quantity for column, one in channels.items() if column not in lateral}
    interval = output_interval(rope.model.solver.step)
    for k in range(len(grid)):
        if k:
            rope.step(interval, paths[k - 1])
        for column, (side, height) in lateral.items():
            found[column][k] = rope.lateral_displacement(side, height)
        if others:
            outputs: Mapping[str, Any] = rope.outputs() if with_forces else rope.sheave()
            for column, quantity in others.items():
                found[column][k, 0] = outputs[quantity]
    return found


def sensor_heights(model: Base) -> Mapping[str, float]:
    """Errors of the heights of sensors [m] by the column of their channels."""
    return getattr(getattr(model, "effects", None), "sensor_height", None) or {}


def watched_heights(model: Base, channels: Mapping[str, Channel]) -> dict[str, tuple[Side, float]]:
    """Side and height [m] at which the sensor of each lateral channel truly looks, by column."""
    sensors, errors = {sensor.name: sensor for sensor in model.sensors}, sensor_heights(model)
    watched = {column: sensors[str(one.sensor)] for column, one in channels.items() if one.quantity == "lateral_displacement"}
    return {column: (sensor.side, sensor.height + errors.get(column, 0.0)) for column, sensor in watched.items()}


def interval_paths(motion: Floats) -> Floats:
    """Paths of the ends over each interval (times - 1, PATHS * PATH), from their motion (times, 4, 3) at its ends."""
    return np.concatenate([motion[:-1], motion[1:]], axis=2).reshape(len(motion) - 1, -1)


def end_motion(model: Base, run: Run, grid: Floats) -> Floats:
    """Position, velocity and acceleration of the four coordinates of the rope's ends: (times, 4, 3) [SI]."""
    motion = np.zeros((len(grid), 4, 3))
    for k, trip in ((0, run.trip), (2, run.counterweight)):
        motion[:, k] = -_derivatives(trip, grid)
    for k, end, sign in ((1, "car", -1.0), (3, "counterweight", 1.0)):
        motion[:, k, 0] = sign * model.sheave.radius
        if end in run.lateral:
            motion[:, k] += sign * _derivatives(run.lateral[end], grid)
    return motion


def _derivatives(trip: Trip, grid: Floats) -> Floats:
    """Position, velocity and acceleration (times, 3) [SI]."""
    return np.column_stack([trip.position(grid), trip.velocity(grid), trip.acceleration(grid)])


def start_of(model: Base, motion: Floats) -> tuple[float, float, tuple[float, float]]:
    """Heights [m] and outward displacements [m] of car and counterweight end at the start of a motion (times, 4, 3)."""
    (car, car_side, counterweight, counterweight_side), radius = motion[0, :, 0], model.sheave.radius
    return -float(car), -float(counterweight), (-float(car_side) - radius, float(counterweight_side) - radius)
