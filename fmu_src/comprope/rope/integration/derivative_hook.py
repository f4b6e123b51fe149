"""Where directional derivatives take part in the loop of time steps: the function that the loop calls, here doing nothing.

`compiler` replaces it by the one of `sensitivity.newmark`, so that integration does not depend on sensitivity.
"""

from ...kernels.jit import kernel


@kernel
def advance_directions(rope, path, step, state, motion, work, directions):
    """Advance the derivatives along all directions over an accepted time step."""
