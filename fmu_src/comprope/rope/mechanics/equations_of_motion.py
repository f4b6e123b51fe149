"""Eq. (1) and (2): the sum of all forces on nodes and sheave, and its tangent.

Effects act through the functions of `effect_hooks`.
"""

from ...kernels.jit import kernel
from ..parameters.parameter_vector import BASE, ELEMENT, RHO, G, J, M
from ..runtime.array_layout import DXX, DXY, DYY
from ..runtime.kernel_arguments import Motion, RopeData, State, Weights, Workspace
from .base_motion import add_base_inertia
from .contact.sheave_contact import add_contact
from .effect_hooks import all_forces, all_moments, all_tangents
from .internal_forces import bend, stretch, sum_forces
from .internal_tangent import assemble, bending_stiffness, fix_end_rows, segment_blocks


@kernel
def forces(n, t, p, motion, h0, work, weights, tangent):
    """Set work.f to the right-hand sides of eq. (1) and (2) at (q, v); with `tangent` set also the contact's tangent.

    h0 is the history of effects before the step; what it becomes goes to work.history.
    """
    m, q, v, w, f = n + 1, motion.q, motion.v, work.w, work.f
    stretch(n, p, q, v, w)
    bend(n, p, w)
    all_moments(n, p, w, h0, work.history, work.power)
    sum_forces(n, p, v, w, f)
    if p[BASE] != 0.0:
        add_base_inertia(n, p, f)
    f[n] = p[M] * p[G]
    f[m + n] = 0.0
    add_contact(n, p, motion, work, weights, tangent)
    all_forces(n, t, p, q, v, w, f, work.power)


@kernel
def forces_of_state(rope: RopeData, state: State, work: Workspace, t: float, weights: Weights, tangent: bool) -> None:
    """The same in the accepted state."""
    forces(rope.n, t, rope.p, Motion(state.q, state.v, state.a), state.history, work, weights, tangent)


@kernel
def tangent_band(n, t, p, motion, work, mass, weights):
    """Set work.A to mass M - ck df/dq - cc df/dv without contact; `forces` must have run at (q, v)."""
    m, w, A = n + 1, work.w, work.A
    ck, cc = weights
    segment_blocks(n, p, w, ck, cc)
    bending_stiffness(n, p, w, ck, cc)
    assemble(n, p, w, A, mass, cc)
    A[DXX * m + n] = mass * p[M]
    A[DXY * m + n] = 0.0
    A[DYY * m + n] = mass * p[J]
    all_tangents(n, t, p, motion.q, motion.v, w, A, weights)
    fix_end_rows(n, A)


@kernel
def node_mass(p):
    """Mass of one inner node [kg]: that of one element."""
    return p[RHO] * p[ELEMENT]
