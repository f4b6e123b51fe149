"""Motion of the building's base, in whose frame the rope moves: the force of inertia on the rope, and its work.

With the base's lateral acceleration b towards the counterweight's side every length of rope feels -rho b. The sheave's axle is
held by its guides, which are part of the base.
"""

from ...kernels.jit import kernel
from ..parameters.parameter_vector import BASE, ELEMENT, RHO


@kernel
def add_base_inertia(n, p, f):
    """Add the force of inertia to all nodes; the ends have half the mass of the others."""
    m, force = n + 1, -p[RHO] * p[ELEMENT] * p[BASE]
    f[m] += 0.5 * force
    for i in range(1, n - 1):
        f[m + i] += force
    f[m + n - 1] += 0.5 * force


@kernel
def base_work(n, p, acceleration, q0, q):
    """Work [J] of that force over a step from q0 to q with a mean acceleration of the base."""
    m, moved = n + 1, 0.0
    for i in range(n):
        moved += (0.5 if i == 0 or i == n - 1 else 1.0) * (q[m + i] - q0[m + i])
    return -p[RHO] * p[ELEMENT] * acceleration * moved
