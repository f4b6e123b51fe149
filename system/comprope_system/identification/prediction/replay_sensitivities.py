"""Replay of a measured run with the derivatives of every channel along directions in the space of parameters."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.interpolate import CubicSpline

from comprope.errors import SimulationError
from comprope.rope.effects import REGISTRY, RopeModel
from comprope.rope.model_file import with_changes
from comprope.rope.parameters import Sensor
from comprope.rope.simulator.parameter_directions import Direction
from comprope.rope.simulator.rope import values_of
from comprope.rope.simulator.sensitive_rope import SensitiveRope

from ..data.runs import Channel, Run
from ..settings import REPLAY
from .replay import (
    Floats,
    Replay,
    end_motion,
    instrument,
    interval_paths,
    output_interval,
    output_times,
    relative_to_rest,
    start_of,
    watched_heights,
)

FORCES = ("force", "tension")
HEIGHT = "effects.sensor_height."
Moves = Mapping[str, Mapping[str, float]]


def replay_with_sensitivities(
    model: RopeModel,
    run: Run,
    channels: Mapping[str, Channel],
    directions: Mapping[str, Direction],
    step: float = REPLAY.time_step,
    at: Mapping[str, Direction] | None = None,
    *,
    exact: bool | None = None,
) -> tuple[Replay, dict[str, dict[str, Floats]]]:
    """Replay of a run, and for each direction the derivative of each channel (n,) at the run's sample times.

    A direction maps model keys to amounts, `{"rope.bending_stiffness": 1.0}`; its derivative is in the channel's SI unit per
    unit of a coefficient of these amounts, which add to the run's own changes. `at` sets, by direction, parameters without
    influence at the point itself, as the frequency of a sway of zero amplitude; `exact` chooses the more accurate derivatives of
    `SensitiveRope`, by default where effects need them. Derivatives are relative to rest where the channel is, and NaN where the
    rope is out of view. `effects.sensor_height.COLUMN` is a parameter too. Raises `SimulationError` where the run or a
    derivative fails.
    """
    changed = with_changes(model, run.changes | {"solver.step": step}, run.file)
    of_rope, heights = _without_heights(directions)
    watching = _watching(changed, channels, heights)
    rope = SensitiveRope(watching, of_rope, at, exact=_has_history(values_of(changed)) if exact is None else exact)
    grid = output_times(run, step)
    found, hidden = _simulated_channels(rope, run, grid, channels, heights)
    if not all(np.abs(one).max() < REPLAY.derivative_limit for one in found.values()):
        raise SimulationError(f"{run.file}: derivatives along the run diverged")
    sampled = {column: CubicSpline(grid, found[column])(run.time) for column in channels}
    for column, values in sampled.items():
        values[np.interp(run.time, grid, hidden[column]) > 0.0] = np.nan
    shown = {column: instrument(changed, column, run.time, values[:, 0]) for column, values in sampled.items()}
    names = (*rope.names, *(name for name in heights if name not in of_rope))
    derivatives = {name: {column: values[:, k] for column, values in sampled.items()} for k, name in enumerate(names, 1)}
    count = rope.rope.count
    return Replay(relative_to_rest(shown, run, channels), count["newton"], count["halved"]), {
        name: relative_to_rest(
            {column: _instrument_derivative(changed, column, run, one) for column, one in own.items()}, run, channels
        )
        for name, own in derivatives.items()
    }


def _without_heights(directions: Mapping[str, Direction]) -> tuple[dict[str, Direction], Moves]:
    """The directions of the rope alone, and by direction how it moves the sensors of channels [m]."""
    of_rope = {name: {key: one for key, one in own.items() if not key.startswith(HEIGHT)} for name, own in directions.items()}
    heights = {
        name: {key.removeprefix(HEIGHT): one for key, one in own.items() if key.startswith(HEIGHT)}
        for name, own in directions.items()
    }
    return {name: own for name, own in of_rope.items() if own or not heights[name]}, {
        name: own for name, own in heights.items() if own
    }


def _watching(model: RopeModel, channels: Mapping[str, Channel], heights: Moves) -> RopeModel:
    """The model with a sensor for each lateral channel, followed by one below and one above each that directions move."""
    watched = watched_heights(model, channels)
    moved = {column for own in heights.values() for column in own}
    places = [*watched.items(), *((column, watched[column]) for column in watched if column in moved for _ in range(2))]
    shifts = [0.0] * len(watched) + [-REPLAY.height_step, REPLAY.height_step] * len(moved)
    sensors = tuple(
        Sensor(name=f"s{k}", side=side, height=height + shift)
        for k, ((_, (side, height)), shift) in enumerate(zip(places, shifts, strict=True))
    )
    return model.model_copy(update={"sensors": sensors})


def _has_history(values: Mapping[str, float]) -> bool:
    """Whether a model with these parameters has effects with state variables, which need `exact` derivatives.

    Hysteresis changes the stiffness within a time step; with the factor of an earlier iteration derivatives may diverge.
    """
    return any(REGISTRY[key.split(".")[1]].states for key in values if key.startswith("effects."))


def _instrument_derivative(model: RopeModel, column: str, run: Run, derivative: Floats) -> Floats:
    """Derivative (n,) of a channel as its instrument shows it: the offset has none."""
    return instrument(model, column, run.time, derivative) - instrument(model, column, run.time, np.zeros_like(derivative))


def _simulated_channels(
    rope: SensitiveRope, run: Run, grid: Floats, channels: Mapping[str, Channel], heights: Moves
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Each channel and its derivatives (times, 1 + directions) on the grid, and where it is out of view (times,).

    Derivatives by directions of `heights` alone come last.
    """
    motion = end_motion(rope.rope.model, run, grid)
    paths = interval_paths(motion)
    rope.solve_equilibrium(*start_of(rope.rope.model, motion), time=float(grid[0]))
    found = {column: np.zeros((len(grid), 1 + len(rope.names))) for column in channels}
    hidden = {column: np.zeros(len(grid)) for column in channels}
    readings = np.zeros((len(grid), len(rope.rope.model.sensors), 2 + len(rope.names)))
    sensors = [column for column, one in channels.items() if one.quantity == "lateral_displacement"]
    others = {column: one.quantity for column, one in channels.items() if column not in sensors}
    interval = output_interval(rope.rope.model.solver.step)
    for k in range(len(grid)):
        if k:
            rope.step(interval, paths[k - 1])
        if sensors:
            readings[k] = rope.read_sensors()
        if others:
            _record_sheave_channels(rope, others, {column: values[k] for column, values in found.items()})
    for j, column in enumerate(sensors):
        found[column][:, 0], hidden[column], found[column][:, 1:] = readings[:, j, 0], 1.0 - readings[:, j, 1], readings[:, j, 2:]
    return _with_heights(rope.names, found, readings[:, :, 0], sensors, heights), hidden


def _with_heights(
    names: Sequence[str], found: dict[str, Floats], seen: Floats, sensors: Sequence[str], heights: Moves
) -> dict[str, Floats]:
    """Channels and derivatives with those by the heights of sensors: the rope's slope, from what is `seen` below and above."""
    alone = [name for name in heights if name not in names]
    found = {column: np.pad(values, ((0, 0), (0, len(alone)))) for column, values in found.items()}
    moved = [column for column in sensors if any(column in own for own in heights.values())]
    for j, column in enumerate(moved):
        below, above = len(sensors) + 2 * j, len(sensors) + 2 * j + 1
        slope = (seen[:, above] - seen[:, below]) / (2.0 * REPLAY.height_step)
        for name, own in heights.items():
            found[column][:, 1 + [*names, *alone].index(name)] += own.get(column, 0.0) * slope
    return found


def _record_sheave_channels(rope: SensitiveRope, others: Mapping[str, str], rows: Mapping[str, Floats]) -> None:
    """Write the value and derivatives (1 + directions,) of channels other than sensors into `rows`."""
    forced = any(quantity.endswith(FORCES) for quantity in others.values())
    values = rope.rope.outputs() if forced else rope.rope.sheave()
    forces = rope.forces() if forced else {}
    for column, quantity in others.items():
        rows[column][0], rows[column][1:] = values[quantity], forces[quantity] if quantity in forces else rope.of_sheave(quantity)
