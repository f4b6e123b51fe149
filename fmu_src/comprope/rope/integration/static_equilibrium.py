"""The suspended shape: rope and sheave at rest, without friction, for any tension.

Newton's method on f(q) = 0 with a mass that holds each iterate near the last one and vanishes as the
residual falls (pseudo-transient continuation), so that it also finds loops too light to wrap the
sheave. The sheave's angle stays where it is: without friction nothing turns it.
"""

from math import isfinite

from ...kernels.jit import kernel
from ..linalg.block_band import back_substitute, factor
from ..linalg.bordered_band import assemble_bordered, factor_bordered, solve_bordered
from ..mechanics.equations_of_motion import forces, tangent_band
from ..mechanics.run_record import slack_segments
from ..parameters.parameter_vector import ELEMENT, RATIO
from ..runtime.array_layout import COLUMNS, CONTACT, DYY, FIRST, LAST, ROWS
from ..runtime.kernel_arguments import Weights

TOLERANCE_AT_REST = 1e-11  # m, the last correction
MOST_ITERATIONS = 400
LARGEST_MOVE = 0.25  # of an element: the longest move of one iteration


@kernel
def solve_equilibrium(n, p, motion, h0, work):
    """Move q to equilibrium, v staying zero; returns the number of iterations, or -1 where none is found.

    The rope is a rod at first, since the chords of an initial guess are all too short; where the shape found has slack segments
    the iteration goes on from it with their own law.
    """
    ratio = p[RATIO]
    p[RATIO] = 1.0
    iterations = iterate_to_equilibrium(n, p, motion, h0, work)
    p[RATIO] = ratio
    if iterations < 0.0 or slack_segments(n, p, work.w) == 0:
        return iterations
    more = iterate_to_equilibrium(n, p, motion, h0, work)
    return more if more < 0.0 else iterations + more


@kernel
def iterate_to_equilibrium(n, p, motion, h0, work):
    """The iteration itself, with the parameters p."""
    m, mass, q, f, r, element = n + 1, 1.0, motion.q, work.f, work.r, p[ELEMENT]
    A, L, B, Z, contact, angle = work.A, work.L, work.B, work.Z, work.contact, q[n + 1 + n]
    for iteration in range(MOST_ITERATIONS):
        forces(n, 0.0, p, motion, h0, work, Weights(1.0, 0.0), True)
        first, last = int(contact[FIRST]) - 1, int(contact[LAST]) + 1
        tangent_band(n, 0.0, p, motion, work, mass, Weights(1.0, 0.0))
        equilibrium_residual(n, f, r)
        lock_angle(n, A, Z)
        factor(n, A, L, r, first, last)
        assemble_bordered(n, A, Z, B, first, last)
        factor_bordered(2 * (last - first + 1), B)
        solve_bordered(n, B, r, first, last)
        back_substitute(n, L, r, first, last)
        largest = 0.0
        for i in range(2 * m):
            if not abs(r[i]) <= largest:
                largest = abs(r[i])
        if not isfinite(largest):
            return -1.0
        scale = min(1.0, LARGEST_MOVE * element / largest) if largest > 0.0 else 1.0
        for i in range(2 * m):
            q[i] += scale * r[i]
        q[m + n] = angle
        if largest < TOLERANCE_AT_REST:
            return iteration + 1.0
        mass = next_pseudo_mass(mass, largest, element)
    return -1.0


@kernel
def next_pseudo_mass(mass, largest, element):
    """The next pseudo-mass: it shrinks fast while moves are small and grows back when they are not."""
    if largest < 1e-3 * element:
        return 0.0
    if largest < 0.25 * element:
        return mass * 0.3
    return min(mass * 2.0, 1e8)


@kernel
def equilibrium_residual(n, f, r):
    """Residual of equilibrium: the forces, none at the prescribed ends nor on the sheave's angle."""
    m = n + 1
    for i in range(2 * m):
        r[i] = f[i]
    for i in (0, n - 1):
        r[i] = 0.0
        r[m + i] = 0.0
    r[m + n] = 0.0


@kernel
def lock_angle(n, A, Z):
    """Keep the sheave's angle: its row and column of the contact tangent go, its diagonal becomes one."""
    m = n + 1
    for i in range(n):
        Z[(COLUMNS + 1) * m + i] = 0.0
        Z[(COLUMNS + 3) * m + i] = 0.0
        Z[(ROWS + 2) * m + i] = 0.0
        Z[(ROWS + 3) * m + i] = 0.0
    for k in range(1, 4):
        Z[CONTACT * m + k] = 0.0
    A[DYY * m + n] = 1.0
