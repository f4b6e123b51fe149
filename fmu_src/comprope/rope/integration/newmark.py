"""Newmark-beta time step of eq. (1) and (2), solved by Newton's method.

Acceleration a is the unknown; q and v follow from it by Newmark's rule with beta = (1 + alpha)^2 / 4
and gamma = 1/2 + alpha, and the forces are weighted (1 - alpha) f_new + alpha f_old (Hilber, Hughes
and Taylor 1977). alpha = 0 is the paper's rule (1/4, 1/2).

Steps that begin or end with slack rope have beta = 1/2, gamma = 1 and alpha = 0: the forces are those at the end of the step, and
nodes move by the mean of their velocities. With segments that lose their stiffness within a thousandth of what they move in a
step, forces of its start would put in energy without bound; those of its end never do so while the forces' potential is convex
(M dv = h f, dq = h (v + dv / 2), so the kinetic energy grows by f dq, which is at most what the potential loses). A body that
falls freely moves exactly.

The tangent is factored once per step and again only when the corrections do not shrink fast. A
correction below `TOLERANCE` metres ends the iteration. A step that does not converge is restored and
halved, up to `MOST_HALVINGS` times; what is accepted has always converged.
"""

from math import isfinite
from typing import NamedTuple

from ...kernels.jit import kernel
from ..linalg.block_band import back_substitute, factor, forward_substitute
from ..linalg.bordered_band import assemble_bordered, factor_bordered, solve_bordered
from ..mechanics.contact.sheave_contact import find_contact_range
from ..mechanics.end_conditions import place_ends
from ..mechanics.equations_of_motion import forces, node_mass, tangent_band
from ..parameters.parameter_vector import ALPHA, ELEMENT, J, M, R
from ..runtime.array_layout import FIRST, LAST
from ..runtime.kernel_arguments import Weights

TOLERANCE = 1e-8  # m
ITERATIONS = 12
SLOW = 0.1  # a correction that shrinks by less than this asks for a new tangent
BESIDE_GROOVE = 32  # nodes beside the groove that still feel its curvature
MOST_HALVINGS = 12  # of one step

# Entries of State.counters: what the simulation has cost so far, and where a failed step went wrong.
STEPS, NEWTON, FACTORED, HALVED, WORST = range(5)
COUNTERS = 5


class Rule(NamedTuple):
    """Newmark's rule with the weighting of forces: alpha, beta, gamma, and (1 - alpha) beta."""

    alpha: float
    beta: float
    gamma: float
    weight: float


@kernel
def time_rule(p, slack):
    """The rule of a step, of one with slack rope or of another."""
    if slack:
        return Rule(0.0, 0.5, 1.0, 0.5)
    alpha = p[ALPHA]
    return Rule(
        alpha, 0.25 * (1.0 + alpha) * (1.0 + alpha), 0.5 + alpha, (1.0 - alpha) * 0.25 * (1.0 + alpha) * (1.0 + alpha)
    )


@kernel
def newmark_weights(rule, h):
    """Weights (ck, cc) of stiffness and damping in the tangent of a step of length h."""
    return Weights(rule.weight * h * h, (1.0 - rule.alpha) * rule.gamma * h)


@kernel
def predict(n, h, state, motion):
    """Start of the iteration: the acceleration stays what it was."""
    q0, v0, a0, q, v, a = state.q, state.v, state.a, motion.q, motion.v, motion.a
    for i in range(2 * (n + 1)):
        a[i] = a0[i]
        v[i] = v0[i] + h * a0[i]
        q[i] = q0[i] + h * (v0[i] + 0.5 * h * a0[i])


@kernel
def advect_acceleration(n, p, rule, h, state, motion, contact):
    """Start of the iteration for the nodes near the sheave, which the rope carries along its own shape.

    That shape hardly changes in a step, but a node runs along it by a good part of an element, and its
    acceleration changes from nothing to v^2 / R on the way. So each node starts with the acceleration
    of the place that it comes to.
    """
    q0, v0, a0, q, v, a = state.q, state.v, state.a, motion.q, motion.v, motion.a
    m, beta, gamma, per_l = n + 1, rule.beta, rule.gamma, 1.0 / p[ELEMENT]
    find_contact_range(n, p, q0, q0[n], 0.0, contact)
    first, last = max(int(contact[FIRST]) - BESIDE_GROOVE, 1), min(int(contact[LAST]) + BESIDE_GROOVE, n - 2)
    for i in range(first, last + 1):
        along = 0.5 * ((q0[i + 1] - q0[i - 1]) * v0[i] + (q0[m + i + 1] - q0[m + i - 1]) * v0[m + i]) * per_l
        place = min(max(i + along * h * per_l, 1.0), n - 2.0)
        k = min(int(place), n - 3)
        s = place - k
        for c in (0, m):
            change = a0[c + k] + s * (a0[c + k + 1] - a0[c + k]) - a0[c + i]
            a[c + i] += change
            v[c + i] += gamma * h * change
            q[c + i] += beta * h * h * change


@kernel
def residual(n, p, rule, a, f, f0, r):
    """Set r = (1 - alpha) f + alpha f_old - M a; prescribed ends have none."""
    m, alpha, mass = n + 1, rule.alpha, node_mass(p)
    for i in range(1, n - 1):
        r[i] = (1.0 - alpha) * f[i] + alpha * f0[i] - mass * a[i]
        r[m + i] = (1.0 - alpha) * f[m + i] + alpha * f0[m + i] - mass * a[m + i]
    r[n] = (1.0 - alpha) * f[n] + alpha * f0[n] - p[M] * a[n]
    r[m + n] = (1.0 - alpha) * f[m + n] + alpha * f0[m + n] - p[J] * a[m + n]
    for i in (0, n - 1):
        r[i] = 0.0
        r[m + i] = 0.0


@kernel
def correct(n, p, rule, h, r, motion, counters):
    """Add the correction r of the acceleration; returns the largest change of position [m]."""
    q, v, a = motion.q, motion.v, motion.a
    m, beta, gamma, largest = n + 1, rule.beta, rule.gamma, 0.0
    for i in range(2 * m):
        change = beta * h * h * r[i]
        a[i] += r[i]
        v[i] += gamma * h * r[i]
        q[i] += change
        size = abs(change) if i < m + n else abs(change) * p[R]
        if not size <= largest:
            largest = size
            counters[WORST] = i
    return largest


@kernel
def factor_tangent(n, t, p, weights, motion, work):
    """Assemble and factor the tangent of the last evaluation of the forces; work.r is eliminated down to the zone.

    The sheave's column of the factor keeps which nodes the zone begins and ends with.
    """
    A, L, B, contact = work.A, work.L, work.B, work.contact
    first, last = int(contact[FIRST]) - 1, int(contact[LAST]) + 1
    tangent_band(n, t, p, motion, work, 1.0, weights)
    factor(n, A, L, work.r, first, last)
    assemble_bordered(n, A, work.Z, B, first, last)
    factor_bordered(2 * (last - first + 1), B)
    L[n], L[2 * n + 1] = first, last


@kernel
def newmark_step(n, p, path, step, state, motion, work):
    """Try one time step from `state`, and set `motion` to what it arrives at; True when Newton's iteration has converged."""
    f, r, L, contact, counters = work.f, work.r, work.L, work.contact, state.counters
    t, h, rule = step.t, step.h, time_rule(p, step.slack)
    weights = newmark_weights(rule, h)
    predict(n, h, state, motion)
    advect_acceleration(n, p, rule, h, state, motion, contact)
    place_ends(n, t, p, path, step.dt, step.s, motion)
    before, fresh, first, last = 1e300, True, 0, 0
    for _ in range(ITERATIONS):
        forces(n, t, p, motion, state.history, work, weights, fresh)
        residual(n, p, rule, motion.a, f, state.f, r)
        if fresh:
            factor_tangent(n, t, p, weights, motion, work)
            first, last = int(contact[FIRST]) - 1, int(contact[LAST]) + 1
            counters[FACTORED] += 1
        else:
            forward_substitute(n, L, r, first, last)
        solve_bordered(n, work.B, r, first, last)
        back_substitute(n, L, r, first, last)
        change = correct(n, p, rule, h, r, motion, counters)
        counters[NEWTON] += 1
        if not isfinite(change):
            return False
        if change < TOLERANCE:
            balance_forces(n, p, rule, motion.a, state.f, f)
            return True
        fresh = change > SLOW * before
        before = change
    return False


@kernel
def balance_forces(n, p, rule, a, f0, f):
    """Forces that balance the accepted accelerations exactly, from the weighted balance of the step.

    The ends keep the forces of the last evaluation.
    """
    m, alpha, mass = n + 1, rule.alpha, node_mass(p)
    for i in range(1, n - 1):
        f[i] = (mass * a[i] - alpha * f0[i]) / (1.0 - alpha)
        f[m + i] = (mass * a[m + i] - alpha * f0[m + i]) / (1.0 - alpha)
    f[n] = (p[M] * a[n] - alpha * f0[n]) / (1.0 - alpha)
    f[m + n] = (p[J] * a[m + n] - alpha * f0[m + n]) / (1.0 - alpha)


@kernel
def copy(size, source, target):
    """Copy `size` numbers."""
    for i in range(size):
        target[i] = source[i]
