"""Arrays of the directional derivatives of one rope: directions, derivatives, and workspace of the kernels."""

from collections.abc import Mapping

import numpy as np

from ..mechanics.end_conditions import PATH, PATHS
from ..parameters.parameter_vector import R
from ..runtime.kernel_arguments import Array, Directions, DirectionsWorkspace
from ..runtime.simd import LANES
from .parameter_directions import (
    Direction,
    begins_history,
    effects_mode,
    largest_step,
    moves_ends,
    parameter_change,
    replaced,
)
from .rope import CompensationRope


def directions_of(
    rope: CompensationRope, directions: Mapping[str, Direction], base: Mapping[str, Direction], *, exact: bool
) -> Directions:
    """The directions as kernels take them; `base` are parameters that some of them start from (see `SensitiveRope`)."""
    p, number, m = rope.p, len(directions), rope.n + 1
    blocks, history_size = -(-number // LANES), rope.workspace.rope.history_size
    change = np.array([parameter_change(rope, one) for one in directions.values()]).reshape(number, p.size)

    def answers() -> Array:
        return np.zeros(blocks * 2 * m * LANES)

    return Directions(
        number, blocks, p.size, int(exact),
        base=np.array([replaced(p, base.get(name, {})) for name in directions]).reshape(-1),
        change=change.reshape(-1),
        dp=in_lanes(change),
        dpath=_path_changes(change).reshape(-1),
        max_step=np.array([largest_step(p, one) for one in change]),
        moves_ends=np.array([moves_ends(p, one) for one in change], float),
        effects_mode=np.array([effects_mode(p, one) for one in change], float),
        new_history=np.array([begins_history(p, one) for one in change], float),
        dq=answers(), dv=answers(), da=answers(), dc=answers(),
        dh=np.zeros(number * history_size),
        work=_workspace(rope, answers(), blocks, number),
    )  # fmt: skip


def _workspace(rope: CompensationRope, D: Array, blocks: int, number: int) -> DirectionsWorkspace:
    p, m, memory = rope.p.size, rope.n + 1, rope.workspace.state.history.size
    sensors = len(rope.model.sensors)
    return DirectionsWorkspace(
        p1=np.zeros(p), frictionless1=np.zeros(p), path1=np.zeros(PATHS * PATH),
        w1=np.zeros(rope.workspace.work.w.size), f1=np.zeros(2 * m), moves=np.zeros(2 * m), elongations=np.zeros(2 * m),
        centre=np.zeros(5 * LANES),
        history_before=np.zeros(memory), history_in=np.zeros(memory), history_out=np.zeros(memory),
        D=D, lift=np.zeros(blocks * LANES), readings=np.zeros(sensors * (2 + number)),
    )  # fmt: skip


def _path_changes(change: Array) -> Array:
    """How the ends' paths move with the directions: with the radius, as they hang over the sheave's sides."""
    paths = np.zeros((len(change), PATHS, PATH))
    paths[:, 3, 0] = paths[:, 3, 3] = change[:, R]
    paths[:, 1] = -paths[:, 3]
    return paths


def in_lanes(rows: Array) -> Array:
    """Rows of numbers as blocks of LANES rows, number by number (see `simd`); rows of zeros fill the last block."""
    padded = np.zeros((-(-len(rows) // LANES) * LANES, rows.shape[1]))
    padded[: len(rows)] = rows
    return padded.reshape(-1, LANES, rows.shape[1]).swapaxes(1, 2).ravel()
