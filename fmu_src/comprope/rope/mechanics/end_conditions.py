"""Prescribed motion of the rope's ends within one communication step.

Each end follows a polynomial of fifth order from the position, velocity and acceleration it has to
those it shall have, so that inputs that arrive once per communication step never make it jump.
A path of one coordinate is six numbers: position, velocity and acceleration at start and end.
"""

from ...kernels.jit import kernel
from ..runtime.kernel_arguments import Ends, Motion, RopeData, State
from .effect_hooks import all_ends

PATHS = 4  # car x, car y, counterweight x, counterweight y
PATH = 6


@kernel
def follow(path, k, dt, s):
    """Position, velocity and acceleration of path k at fraction s of a step of length dt [s].

    Quintic Hermite interpolation, exact for motions up to fifth order in time.
    """
    b = PATH * k
    x0, v0, a0 = path[b], path[b + 1] * dt, path[b + 2] * dt * dt
    x1, v1, a1 = path[b + 3], path[b + 4] * dt, path[b + 5] * dt * dt
    rise, climb, bow = x1 - x0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0
    c3 = 10.0 * rise - 4.0 * climb + 0.5 * bow
    c4 = -15.0 * rise + 7.0 * climb - bow
    c5 = 6.0 * rise - 3.0 * climb + 0.5 * bow
    x = x0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))
    v = v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))
    a = a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))
    return x, v / dt, a / (dt * dt)


@kernel
def place_ends(n, t, p, path, dt, s, motion):
    """Put both ends where their paths have them at fraction s, then let effects move them."""
    m, q, v, a = n + 1, motion.q, motion.v, motion.a
    for k, i in ((0, 0), (1, m), (2, n - 1), (3, m + n - 1)):
        q[i], v[i], a[i] = follow(path, k, dt, s)
    all_ends(n, t, p, q, v, a)


@kernel
def place_ends_of_state(rope: RopeData, ends: Ends, state: State, t: float, dt: float, s: float) -> None:
    """The same for the accepted state."""
    place_ends(rope.n, t, rope.p, ends.path, dt, s, Motion(state.q, state.v, state.a))
