"""Where directions are kept, and how far along one it is differenced.

Directions go in blocks of LANES: number (node i, component c) of direction k in dq, dv, da, dc and D sits at
(k // LANES 2 m + 2 i + c) LANES + k % LANES, as `lanes` has it. `dp` has the parameters' changes in
the same way, and `at` and `toward`, direction after direction, where the parameters begin and how they change.
"""

from ..runtime.jit import kernel
from ..runtime.simd import LANES

MOVE = 1e-7  # m, the largest move by which effects are differenced
PERIOD = 0.1  # s, by which velocities are compared with moves
TURN = 1e-3  # share of the sheave's turn, which matters to forces through an eccentric groove alone
COARSE = 32  # nodes between those that are asked for the largest move


@kernel
def entry(m, k):
    """Where the entries of direction k begin."""
    return (k // LANES * 2 * m) * LANES + k % LANES


@kernel
def shift(parameters, k, e, at, toward, p1):
    """Set p1 to the parameters of direction k, e along it."""
    for j in range(parameters):
        p1[j] = at[parameters * k + j] + e * toward[parameters * k + j]


@kernel
def gauge(n, b, radius, limit, dq, dv):
    """The step e by which the direction that begins at b is differenced: a largest move of MOVE, and at most `limit`."""
    largest = 0.0
    for i in range(0, n, COARSE):
        k = b + 2 * LANES * i
        largest = max(largest, abs(dq[k]), abs(dq[k + LANES]), PERIOD * abs(dv[k]), PERIOD * abs(dv[k + LANES]))
    k = b + 2 * LANES * n
    largest = max(largest, abs(dq[k]), PERIOD * abs(dv[k]))
    largest = max(largest, radius * TURN * abs(dq[k + LANES]), radius * PERIOD * abs(dv[k + LANES]))
    return limit if largest * limit <= MOVE else MOVE / largest
