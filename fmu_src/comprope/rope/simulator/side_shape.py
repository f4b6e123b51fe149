"""Shape of one side of the rope: lateral displacement over height."""


import numpy as np
from numpy.typing import NDArray

from .rope import CompensationRope

Floats = NDArray[np.float64]


def side_shape(rope: CompensationRope, side: str, heights: Floats) -> Floats:
    """Outward displacement [m] of a side at `heights` [m]; NaN above its end and below the axle.

    Linear between nodes; a rope that folds back is read at its nodes nearest to the end.
    """
    n, q = rope.n, rope.state.q
    x, y, axle = q[:n], q[n + 1 : -1], q[n]
    if side == "counterweight":
        x, y = x[::-1], y[::-1]
    sign = 1.0 if side == "counterweight" else -1.0
    below = np.flatnonzero((x > axle) | (np.diff(x, append=np.inf) <= 0.0))
    stop = int(below[0]) + 1 if below.size else len(x)
    return np.interp(-heights, x[:stop], sign * y[:stop] - rope.model.sheave.radius, left=np.nan, right=np.nan)
