"""The model driven by a measured run, with the derivative of every channel along directions of its parameters."""

from collections.abc import Mapping

import numpy as np
from scipy.interpolate import CubicSpline

from comprope.errors import SimulationError
from comprope.rope.effects import REGISTRY, RopeModel
from comprope.rope.model_file import with_changes
from comprope.rope.simulator.parameter_directions import Direction
from comprope.rope.simulator.rope import values_of
from comprope.rope.simulator.sensitive_rope import SensitiveRope

from ..data.campaign import Channel, Run
from ..settings import REPLAY
from .replay import Floats, Replay, _paths, instrument, relative_to_rest

FORCES = ("force", "tension")


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
    """What `replay` gives, and for each direction the derivative of each channel at the run's sample times.

    A direction maps keys of the model to amounts, `{"rope.bending_stiffness": 1.0}`; its derivative is in the channel's SI
    unit per one times these amounts, which add to what the run itself has changed. `at` sets values that do nothing before the
    direction does, and `exact` spends more on accuracy (see `SensitiveRope`), by default where effects need it. Derivatives
    count from rest where the channel does, and are NaN where the rope is not in view. Raises `SimulationError` where the run or
    a derivative fails.
    """
    changed = with_changes(model, run.changes | {"solver.step": step}, run.file)
    rope = SensitiveRope(changed, directions, at, exact=_sticking(values_of(changed)) if exact is None else exact)
    grid = run.time[0] + REPLAY.output_interval * np.arange(
        int(np.ceil((run.time[-1] - run.time[0]) / REPLAY.output_interval)) + 2
    )
    seen, hidden = _drive(rope, run, grid, channels)
    if not all(np.abs(one).max() < REPLAY.derivative_limit for one in seen.values()):
        raise SimulationError(f"{run.file}: derivatives along the run grew beyond all numbers")
    sampled = {column: CubicSpline(grid, seen[column])(run.time) for column in channels}
    for column, values in sampled.items():
        values[np.interp(run.time, grid, hidden[column]) > 0.0] = np.nan
    shown = {column: instrument(changed, column, run.time, values[:, 0]) for column, values in sampled.items()}
    derivatives = {name: {column: values[:, k] for column, values in sampled.items()} for k, name in enumerate(rope.names, 1)}
    count = rope.rope.count
    return Replay(relative_to_rest(shown, run, channels), count["newton"], count["halved"]), {
        name: relative_to_rest({column: _through(changed, column, run, one) for column, one in own.items()}, run, channels)
        for name, own in derivatives.items()
    }


def _sticking(values: Mapping[str, float]) -> bool:
    """Whether a model of these values has effects with a history, which need `exact` derivatives.

    Wires that stick and slip change the rope's stiffness within a step: with the older factor derivatives may grow without end.
    """
    return any(REGISTRY[key.split(".")[1]].states for key in values if key.startswith("effects."))


def _through(model: RopeModel, column: str, run: Run, derivative: Floats) -> Floats:
    """What a channel's instrument makes of a derivative: all but its offset."""
    return instrument(model, column, run.time, derivative) - instrument(model, column, run.time, np.zeros_like(derivative))


def _drive(
    rope: SensitiveRope, run: Run, grid: Floats, channels: Mapping[str, Channel]
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Each channel and its derivatives (times, 1 + directions) on the grid, and where it is out of view (times,)."""
    paths = _paths(rope.rope.model, run, grid)
    rope.solve_equilibrium(-paths[0, 0, 0], -paths[0, 2, 0], time=float(grid[0]))
    seen = {column: np.zeros((len(grid), 1 + len(rope.names))) for column in channels}
    hidden = {column: np.zeros(len(grid)) for column in channels}
    looked = np.zeros((len(grid), len(rope.rope.model.sensors), 2 + len(rope.names)))
    lasers = {column: _number(rope, one) for column, one in channels.items() if one.quantity == "lateral_displacement"}
    others = {column: one.quantity for column, one in channels.items() if column not in lasers}
    for k in range(len(grid)):
        if k:
            rope.step(REPLAY.output_interval, np.concatenate([paths[k - 1], paths[k]], axis=1).ravel())
        if lasers:
            looked[k] = rope.read_sensors()
        if others:
            _note(rope, others, {column: values[k] for column, values in seen.items()})
    for column, j in lasers.items():
        seen[column][:, 0], hidden[column], seen[column][:, 1:] = looked[:, j, 0], 1.0 - looked[:, j, 1], looked[:, j, 2:]
    return seen, hidden


def _number(rope: SensitiveRope, channel: Channel) -> int:
    """Number of the sensor that a channel reads."""
    return [one.name for one in rope.rope.model.sensors].index(str(channel.sensor))


def _note(rope: SensitiveRope, others: Mapping[str, str], rows: Mapping[str, Floats]) -> None:
    """Note what channels other than lasers show now: for each the value, then its derivatives."""
    forced = any(quantity.endswith(FORCES) for quantity in others.values())
    values = rope.rope.outputs() if forced else rope.rope.sheave()
    forces = rope.forces() if forced else {}
    for column, quantity in others.items():
        rows[column][0], rows[column][1:] = values[quantity], forces[quantity] if quantity in forces else rope.of_sheave(quantity)
