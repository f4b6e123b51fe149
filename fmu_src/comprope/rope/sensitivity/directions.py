"""Storage of directions, and the step along one by which forces are differenced.

Directions go in blocks of LANES: number (node i, component c) of direction k in dq, dv, da, dc and D is at
(k // LANES 2 m + 2 i + c) LANES + k % LANES, as `simd` loads it. `dp` has the parameters' changes in
the same way: quantity j of a block at (parameters block + j) LANES. `base` and `change` hold, direction after
direction, the parameters it starts from and how they change.
"""

from ...kernels.jit import kernel
from ..runtime.simd import LANES

LARGEST_DIFFERENCE = 1e-7  # m, the largest move by which effects are differenced
PERIOD = 0.1  # s, by which velocities are compared with moves
TURN = 1e-3  # share of the sheave's turn, which matters to forces through an eccentric groove alone
STRIDE = 32  # nodes between those that are asked for the largest move


@kernel
def first_entry(m, k):
    """Index of the first number of direction k."""
    return (k // LANES * 2 * m) * LANES + k % LANES


@kernel
def shift_parameters(directions, k, e):
    """Set work.p1 to the parameters a step e along direction k."""
    first, p1 = directions.parameters * k, directions.work.p1
    for j in range(directions.parameters):
        p1[j] = directions.base[first + j] + e * directions.change[first + j]


@kernel
def difference_step(n, radius, directions, k):
    """The step by which direction k is differenced: a largest move of LARGEST_DIFFERENCE, and at most its `max_step`."""
    b, limit, dq, dv, largest = first_entry(n + 1, k), directions.max_step[k], directions.dq, directions.dv, 0.0
    for i in range(0, n, STRIDE):
        j = b + 2 * LANES * i
        largest = max(largest, abs(dq[j]), abs(dq[j + LANES]), PERIOD * abs(dv[j]), PERIOD * abs(dv[j + LANES]))
    j = b + 2 * LANES * n
    largest = max(largest, abs(dq[j]), PERIOD * abs(dv[j]))
    largest = max(largest, radius * TURN * abs(dq[j + LANES]), radius * PERIOD * abs(dv[j + LANES]))
    return limit if largest * limit <= LARGEST_DIFFERENCE else LARGEST_DIFFERENCE / largest
