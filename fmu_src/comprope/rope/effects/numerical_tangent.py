"""Tangents of an effect that gives none, by differences of its forces: each node's force by that node's own motion.

Nodes are moved three at a time apart, so that the force on one knows nothing of another's move. Forces between nodes and
what they read from the workspace w are left out, so Newton's iteration may take more steps than with tangents by hand.
"""

from typing import Any

from ...kernels.jit import stack_array
from ..runtime.array_layout import DXX, DXY, DYY

STEP = 1e-6  # m or m/s, by which nodes are moved
APART = 3
effect_kernel: Any = None  # forces of the effect: `compiler` puts its kernel here


def difference_forces(n, t, p, q, v, w, A, weights):
    """Subtract ck df/dq + cc df/dv from A (ck, cc = weights): positions and velocities are moved together, in that proportion."""
    ck, cc = weights
    m, e = n + 1, STEP / max(abs(ck), abs(cc))
    q1, v1, f0, f1 = stack_array(2 * m), stack_array(2 * m), stack_array(2 * m), stack_array(2 * m)
    for k in range(2 * m):
        q1[k], v1[k], f0[k] = q[k], v[k], 0.0
    effect_kernel(n, t, p, q1, v1, w, f0)
    for c in (0, m):
        for first in range(1, 1 + APART):
            for k in range(2 * m):
                f1[k] = 0.0
            for i in range(first, m, APART):
                q1[c + i] += e * ck
                v1[c + i] += e * cc
            effect_kernel(n, t, p, q1, v1, w, f1)
            for i in range(first, m, APART):
                x, y = (f1[i] - f0[i]) / e, (f1[m + i] - f0[m + i]) / e
                A[DXX * m + i] -= x if c == 0 else 0.0
                A[DXY * m + i] -= 0.5 * (y if c == 0 else x)
                A[DYY * m + i] -= 0.0 if c == 0 else y
                q1[c + i], v1[c + i] = q[c + i], v[c + i]
