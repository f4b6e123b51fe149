"""Static equilibrium with changed parameters, for derivatives of the initial state."""

from ...kernels.jit import kernel
from ..integration.static_equilibrium import solve_equilibrium
from ..mechanics.effect_hooks import all_begin
from ..mechanics.end_conditions import place_ends
from ..mechanics.equations_of_motion import forces
from ..runtime.kernel_arguments import Directions, Motion, RopeData, Weights, Workspace


@kernel
def solve_changed_equilibrium(rope: RopeData, motion: Motion, work: Workspace, directions: Directions, t: float) -> float:
    """Move motion.q to equilibrium with the parameters and the path in directions.work; sets the history of a rope at rest there.

    Returns the number of iterations, or -1 where no equilibrium is found.
    """
    n, changed = rope.n, directions.work
    place_ends(n, t, changed.p1, changed.path1, 1.0, 0.0, motion)
    for i in range(2 * (n + 1)):
        motion.v[i] = 0.0
    iterations = solve_equilibrium(n, changed.frictionless1, motion, changed.history_in, work)
    forces(n, t, changed.frictionless1, motion, changed.history_in, work, Weights(0.0, 0.0), False)
    all_begin(n, changed.p1, work.w, changed.history_in)
    return iterations
