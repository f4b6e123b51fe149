"""The model driven by a measured run, with the derivative of every channel along directions of its parameters."""

from collections.abc import Mapping

import numpy as np
from scipy.interpolate import CubicSpline

from comprope.rope.effects import RopeModel
from comprope.rope.modelfile import with_changes
from comprope.rope.sensitivity import Direction, SensitiveRope

from .campaign import Channel, Run
from .replay import GRID, STEP, Floats, Replay, _paths, instrument, referred

FORCES = ("force", "tension")


def replay_with_sensitivities(
    model: RopeModel,
    run: Run,
    channels: Mapping[str, Channel],
    directions: Mapping[str, Direction],
    step: float = STEP,
    at: Mapping[str, Direction] | None = None,
    *,
    exact: bool = False,
) -> tuple[Replay, dict[str, dict[str, Floats]]]:
    """What `replay` gives, and for each direction the derivative of each channel at the run's sample times.

    A direction maps keys of the model to amounts, `{"rope.bending_stiffness": 1.0}`; its derivative is in the
    channel's SI unit per one times these amounts. They are added to what the run itself has changed. `at` sets values that do nothing
    before the direction does, and `exact` spends more on accuracy (see `SensitiveRope`). Derivatives count from rest where the channel does, and
    are NaN where the rope is not in view.
    """
    changed = with_changes(model, run.changes | {"solver.step": step}, run.file)
    rope = SensitiveRope(changed, directions, at, exact=exact)
    grid = run.time[0] + GRID * np.arange(int(np.ceil((run.time[-1] - run.time[0]) / GRID)) + 2)
    seen, hidden = _drive(rope, run, grid, channels)
    sampled = {column: CubicSpline(grid, seen[column])(run.time) for column in channels}
    for column, values in sampled.items():
        values[np.interp(run.time, grid, hidden[column]) > 0.0] = np.nan
    shown = {column: instrument(changed, column, run.time, values[:, 0]) for column, values in sampled.items()}
    derivatives = {name: {column: values[:, k] for column, values in sampled.items()} for k, name in enumerate(rope.names, 1)}
    count = rope.rope.count
    return Replay(referred(shown, run, channels), count["newton"], count["halved"]), {
        name: referred({column: _through(changed, column, run, one) for column, one in own.items()}, run, channels)
        for name, own in derivatives.items()
    }


def _through(model: RopeModel, column: str, run: Run, derivative: Floats) -> Floats:
    """What a channel's instrument makes of a derivative: all but its offset."""
    return instrument(model, column, run.time, derivative) - instrument(model, column, run.time, np.zeros_like(derivative))


def _drive(rope: SensitiveRope, run: Run, grid: Floats, channels: Mapping[str, Channel]) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Each channel and its derivatives (times, 1 + directions) on the grid, and where the rope is out of view (times,)."""
    paths = _paths(rope.rope.model, run, grid)
    rope.settle(-paths[0, 0, 0], -paths[0, 2, 0], time=float(grid[0]))
    seen = {column: np.zeros((len(grid), 1 + len(rope.names))) for column in channels}
    hidden = {column: np.zeros(len(grid)) for column in channels}
    for k in range(len(grid)):
        if k:
            rope.step(GRID, np.concatenate([paths[k - 1], paths[k]], axis=1).ravel())
        _note(rope, channels, k, seen, hidden)
    return seen, hidden


def _note(rope: SensitiveRope, channels: Mapping[str, Channel], k: int, seen: dict[str, Floats], hidden: dict[str, Floats]) -> None:
    """Note what all channels show at the grid's time k."""
    sensors = {sensor.name: (j, sensor) for j, sensor in enumerate(rope.rope.model.sensors)}
    forced = any(one.quantity.endswith(FORCES) for one in channels.values())
    values = rope.rope.outputs() if forced else rope.rope.sheave()
    slopes = rope.sheave() | (rope.forces() if forced else {})
    sights = rope.lateral_displacement()
    for column, channel in channels.items():
        row = seen[column][k]
        if channel.quantity == "lateral_displacement":
            j, sensor = sensors[str(channel.sensor)]
            row[0], visible = rope.rope.lateral_displacement(sensor.side, sensor.height)
            row[1:], hidden[column][k] = sights[j], not visible
        else:
            row[0], row[1:] = values[channel.quantity], slopes[channel.quantity]
