"""Directional derivatives along a simulation: the linearised time step, with the factor that the step itself has left.

A direction is a change dp of the parameter vector; (dq, dv, da) is how the motion answers. From the same
predictor as the step's own, dq = dq0 + h (dv0 + h/2 da0), dv = dv0 + h da0, one correction r solves

    J r = (1 - alpha) D + dc - dM a,        dc = alpha df0 - M da0,
    da = da0 + r,  dv += gamma h r,  dq += beta h^2 r,

where J is the tangent of the step, alpha, beta and gamma are its rule, and D is the directional derivative of the forces (see
`equations_of_motion`), which is exact. J may be that of the iterate which was factored, with the contact's share renewed: that
errs in the correction alone; or it is renewed as a whole (`exact`). The next dc follows from the balance of the step.
What the ends do with dp is read off their paths by differences. How directions are stored: see `directions`.
"""

from ...kernels.jit import kernel
from ..integration.newmark import factor_tangent, newmark_weights, time_rule
from ..linalg.bordered_band import assemble_bordered, factor_bordered
from ..linalg.multi_rhs import solve_lanes
from ..mechanics.contact.contact_tangent import clear_contact_tangent
from ..mechanics.contact.sheave_contact import add_pieces, place_groove
from ..mechanics.equations_of_motion import forces, node_mass
from ..parameters.parameter_vector import ALPHA, J, M
from ..runtime.array_layout import FIRST, LAST
from ..runtime.kernel_arguments import Motion, Weights
from ..runtime.simd import LANES, load, store
from .effects import advance_histories, any_changed_effects, present_effect_forces
from .end_conditions import place_ends_of_directions
from .equations_of_motion import force_derivatives
from .internal_forces import Combination, elongations, mass_derivative, predicted

GROUP = 3  # blocks that are carried on at once: enough to fill each other's waiting, few enough to stay at hand


@kernel
def factor_contact_tangent(n, p, weights, motion, work):
    """Factor the contact's tangent in the state reached anew in the factor's zone; work.f is free for use.

    The contact changes most between the iterate that was factored and the state reached; the rope's share in A
    stays as it was.
    """
    L, contact, f, q, m = work.L, work.contact, work.f, motion.q, n + 1
    first, last = int(L[n]), int(L[2 * n + 1])
    contact[FIRST], contact[LAST] = first + 1.0, last - 1.0
    clear_contact_tangent(n, work.Z, first + 1, last - 1)
    for i in range(first, last + 1):
        f[i], f[m + i] = 0.0, 0.0
    f[n], f[m + n] = 0.0, 0.0
    add_pieces(n, p, motion, place_groove(p, q[n], q[m + n]), work, weights, True)
    assemble_bordered(n, work.A, work.Z, work.B, first, last)
    factor_bordered(2 * (last - first + 1), work.B)


@kernel
def prepare_directions(rope, step, state, work, directions):
    """Find what all directions start from in the state reached: J, elongations, and forces of effects if any change."""
    n, p, t, before = rope.n, rope.p, step.t, directions.work.history_before
    weights = newmark_weights(time_rule(p, step.slack), step.h)
    motion, changed = Motion(state.q, state.v, state.a), any_changed_effects(directions)
    if directions.exact:
        forces(n, t, p, motion, before, work, weights, True)
        factor_tangent(n, t, p, weights, motion, work)
    else:
        if changed:
            forces(n, t, p, motion, before, work, Weights(0.0, 0.0), False)
        factor_contact_tangent(n, p, weights, motion, work)
    elongations(n, p, state.v, work.w, directions.work.elongations)
    if changed:
        present_effect_forces(rope, t, state, work, directions)


@kernel
def correct_entry(k, rule, mass, inertia, directions):
    """Add the correction at entry k; `inertia` is dM a there. The balance of the step gives the next dc."""
    h, half, by_q, by_v, gain = rule
    dq, dv, da, dc = directions.dq, directions.dv, directions.da, directions.dc
    r = load(directions.work.D, k)
    x, v = predicted(k, h, half, dq, dv, da)
    a = load(da, k) + r
    store(dq, k, x + by_q * r)
    store(dv, k, v + by_v * r)
    store(da, k, a)
    store(dc, k, gain * (mass * r + inertia - load(dc, k)) - mass * a)


@kernel
def correct_block(n, p, step, a0, block, directions):
    """Add the corrections in a block of D."""
    dp, d, base = directions.dp, directions.parameters * LANES * block, 2 * (n + 1) * LANES * block
    m, h, mass, dmass = n + 1, step.h, node_mass(p), mass_derivative(p, dp, d)
    taken = time_rule(p, step.slack)
    rule = (h, 0.5 * h * h, taken.beta * h * h, taken.gamma * h, p[ALPHA] / (1.0 - taken.alpha))
    for i in range(n):
        k = base + 2 * LANES * i
        correct_entry(k, rule, mass, a0[i] * dmass, directions)
        correct_entry(k + LANES, rule, mass, a0[m + i] * dmass, directions)
    k = base + 2 * LANES * n
    correct_entry(k, rule, p[M], a0[n] * load(dp, d + M * LANES), directions)
    correct_entry(k + LANES, rule, p[J], a0[m + n] * load(dp, d + J * LANES), directions)


@kernel
def drop_old_forces(rope, directions):
    """Set dc to -M da0: what a step leaves for one that takes the forces at its end alone."""
    n, p, da, dc = rope.n, rope.p, directions.da, directions.dc
    for block in range(directions.blocks):
        base = 2 * (n + 1) * LANES * block
        for k in range(2 * LANES * n):
            dc[base + k] = -node_mass(p) * da[base + k]
        for k in range(LANES):
            b = base + 2 * LANES * n + k
            dc[b], dc[b + LANES] = -p[M] * da[b], -p[J] * da[b + LANES]


@kernel
def solve_blocks(rope, step, begin, end, state, work, directions):
    """Solve for the corrections of some blocks, whose right-hand sides are in D, and add them; prescribed ends have none."""
    n, L, D = rope.n, work.L, directions.work.D
    size = 2 * (n + 1) * LANES
    for block in range(begin, end):
        for k in range(2 * LANES):
            D[size * block + k], D[size * block + 2 * LANES * (n - 1) + k] = 0.0, 0.0
    solve_lanes(n, L, work.B, D, begin, end, int(L[n]), int(L[2 * n + 1]))
    for block in range(begin, end):
        correct_block(n, rope.p, step, state.a, block, directions)


@kernel
def advance_directions(rope, path, step, state, motion, work, directions):
    """Advance all directions over an accepted time step, which has ended in `state`.

    work.history_before of the directions is the history before the step; `motion` and work.f are free for use; work.w is of
    the state reached, or within the step's tolerance of it.
    """
    if directions.number == 0:
        return
    prepare_directions(rope, step, state, work, directions)
    place_ends_of_directions(rope.n, path, step, state, motion, directions)
    if step.slack:
        drop_old_forces(rope, directions)
    combination = Combination(step.h, 1.0 - time_rule(rope.p, step.slack).alpha, 1.0)
    for begin in range(0, directions.blocks, GROUP):
        end = min(begin + GROUP, directions.blocks)
        force_derivatives(rope, step.t, combination, (begin, end), state, motion, work, directions)
        solve_blocks(rope, step, begin, end, state, work, directions)
    advance_histories(rope, step.t, state, motion, work, directions)
