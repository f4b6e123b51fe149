"""Eq. (1) and (2): the sum of all forces on nodes and sheave, and its tangent.

Effects act through the functions of `hooks`.
"""

from ..runtime.array_layout import DXX, DXY, DYY
from ..runtime.jit import kernel
from ..runtime.parameter_vector import ELEMENT, RHO, G, J, M
from .effect_hooks import all_forces, all_moments, all_tangents
from .internal_forces import assemble, bend, bending_stiffness, hold_ends, segment_blocks, stretch, sum_forces
from .sheave_contact import add_contact


@kernel
def forces(n, t, p, q, v, w, f, touch, h0, h1, power, Z, ck, cc, tangent):
    """Set f to the right-hand sides of eq. (1) and (2) at (q, v); with `tangent` set also Z."""
    m = n + 1
    stretch(n, p, q, v, w)
    bend(n, p, w)
    all_moments(n, p, w, h0, h1, power)
    sum_forces(n, p, v, w, f)
    f[n] = p[M] * p[G]
    f[m + n] = 0.0
    add_contact(n, p, q, v, f, touch, Z, ck, cc, tangent)
    all_forces(n, t, p, q, v, w, f, power)


@kernel
def tangent_band(n, t, p, q, v, w, A, mass, ck, cc):
    """Set A to mass M - ck df/dq - cc df/dv without contact; `forces` must have run at (q, v)."""
    m = n + 1
    segment_blocks(n, p, w, ck, cc)
    bending_stiffness(n, p, w, ck, cc)
    assemble(n, p, w, A, mass, cc)
    A[DXX * m + n] = mass * p[M]
    A[DXY * m + n] = 0.0
    A[DYY * m + n] = mass * p[J]
    all_tangents(n, t, p, q, v, w, A, ck, cc)
    hold_ends(n, A)


@kernel
def node_mass(p):
    """Mass of one inner node [kg]: that of one element."""
    return p[RHO] * p[ELEMENT]
