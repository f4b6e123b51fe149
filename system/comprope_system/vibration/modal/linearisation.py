"""Linearisation of the suspended rope: stiffness and mass matrices about the static shape.

The stiffness is the tangent that the time step uses: the block band of tension and bending, and the
blocks of the contact. Assumptions about the sheave:

- it is free: its height and its angle are unknowns, with its mass and its inertia;
- the rope sticks to it. Regularised friction is a strong damper at rest; for slow small vibration it
  prevents slip, and is replaced by a spring of `STICK` N/m for each N s/m. Rope and
  sheave then rotate together.

Damping and the stiffness of effects are neglected.
"""

from dataclasses import dataclass
from functools import cache
from types import FunctionType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array

from comprope.rope.mechanics import (
    axial_law,
    base_motion,
    effect_hooks,
    equations_of_motion,
    internal_forces,
    internal_tangent,
)
from comprope.rope.mechanics.contact import contact_law, contact_tangent, sheave_contact
from comprope.rope.parameters.parameter_vector import C
from comprope.rope.runtime import array_layout
from comprope.rope.runtime.kernel_arguments import Motion, Weights, Workspace
from comprope.rope.simulator.rope import CompensationRope

Floats = NDArray[np.float64]

# 1/s; 100 is felt as a spring that lowers the sheave's rotation from 13.5 to 12.7 Hz, this by 0.3 %. Much more would hold the
# rope where it hardly touches the groove: ten times as much changes lateral periods by up to 5e-5 of themselves at 5 cm.
STICK = 2e3


@dataclass(frozen=True)
class Linear:
    """Stiffness K (k, k) and masses (k,) of the unknowns `free` (k,) among those of the rope's state.

    Unknown i < n is node i's x (down), n the sheave's height; n + 1 + i is node i's y, the last one the angle.
    """

    stiffness: csc_array
    mass: Floats
    free: NDArray[np.int64]
    n: int

    def full(self, vector: Floats) -> Floats:
        """A vector of the free unknowns (k,) among all unknowns (2, n + 1): rows x and y."""
        whole = np.zeros(2 * (self.n + 1))
        whole[self.free] = vector
        return whole.reshape(2, self.n + 1)


def linearise(rope: CompensationRope) -> Linear:
    """Stiffness and mass about the present shape of a rope, which must be at rest."""
    n, m = rope.n, rope.n + 1
    p = np.asarray(rope.p).copy()
    band, contact, first, last = _tangent(rope, p, 1.0, 0.0)
    p[C] = 0.0
    _, friction, _, _ = _tangent(rope, p, 0.0, STICK)
    entries = _Entries(m)
    _add_band(entries, band.reshape(array_layout.BAND, m))
    _add_contact(entries, contact + friction, first - 1, last + 1)
    free = np.setdiff1d(np.arange(2 * m), [0, n - 1, m, m + n - 1])
    stiffness = entries.matrix()[free][:, free]
    return Linear(csc_array(0.5 * (stiffness + stiffness.T)), _masses(rope)[free], free, n)


def _masses(rope: CompensationRope) -> Floats:
    node = rope.model.rope.mass_per_length * rope.element
    x, y = np.full(rope.n, node), np.full(rope.n, node)
    return np.concatenate([x, [rope.model.sheave.mass_per_rope], y, [rope.model.sheave.inertia_per_rope]])


def _tangent(rope: CompensationRope, p: Floats, ck: float, cc: float) -> tuple[Floats, Floats, int, int]:
    """-ck df/dq - cc df/dv at rest: the rope's band, the contact's blocks, and the nodes these reach from and to."""
    n, m, kernels = rope.n, rope.n + 1, _interpreted()
    sizes = (array_layout.SECTIONS * m, array_layout.BAND * m, array_layout.CONTACT * m + 4, 2 * m, 2 * m)
    arrays: Any = ([0.0] * size for size in (*sizes, array_layout.CONTACT_RESULTS, 1))
    w, A, Z, v, f, found, none = arrays
    q: Any = np.asarray(rope.state.q).tolist()
    values, motion = p.tolist(), Motion(q, v, none)
    work = Workspace(w, f, none, none, found, none, A, none, none, Z, none, none)
    kernels["forces"](n, 0.0, values, motion, none, work, Weights(ck, cc), True)
    kernels["tangent_band"](n, 0.0, values, motion, work, 0.0, Weights(ck, cc))
    return np.array(A), np.array(Z), int(found[array_layout.FIRST]), int(found[array_layout.LAST])


@cache
def _interpreted() -> dict[str, Any]:
    """The kernels without effects as interpreted Python functions on lists: faster than compilation for two calls."""
    modules = (
        effect_hooks, axial_law, base_motion, internal_forces, internal_tangent, contact_law, contact_tangent, sheave_contact,
        equations_of_motion,
    )  # fmt: skip
    names = {key: value for module in modules for key, value in vars(module).items()}
    for key, value in names.items():
        function = getattr(value, "py_func", value)
        if isinstance(function, FunctionType):
            names[key] = FunctionType(function.__code__, names, key)
    return names


class _Entries:
    """Entries of a sparse matrix of 2 m unknowns, gathered and summed."""

    def __init__(self, m: int) -> None:
        self.m = m
        self.rows: list[NDArray[np.int64]] = []
        self.columns: list[NDArray[np.int64]] = []
        self.values: list[Floats] = []

    def add(self, rows: NDArray[np.int64], columns: NDArray[np.int64], values: Floats) -> None:
        """Add values at places, all of one shape (k,)."""
        self.rows.append(rows)
        self.columns.append(columns)
        self.values.append(values)

    def matrix(self) -> csc_array:
        """The matrix (2 m, 2 m)."""
        places = (np.concatenate(self.rows), np.concatenate(self.columns))
        return csc_array(coo_array((np.concatenate(self.values), places), shape=(2 * self.m, 2 * self.m)))


def _add_band(entries: _Entries, band: Floats) -> None:
    """The symmetric block band: a node with itself, with the next one, with the one after."""
    m, nodes = entries.m, np.arange(entries.m - 1)
    for c in range(2):
        for d in range(2):
            entries.add(c * m + nodes, d * m + nodes, band[array_layout.DXX + c + d, :-1])
            for step, base in ((1, array_layout.EXX), (2, array_layout.GXX)):
                here, there, values = c * m + nodes[:-step], d * m + nodes[step:], band[base + 2 * c + d, : -1 - step]
                entries.add(here, there, values)
                entries.add(there, here, values)


def _add_contact(entries: _Entries, blocks: Floats, first: int, last: int) -> None:
    """The contact's blocks of nodes first .. last: with nodes up to two away, and with the sheave."""
    m, nodes = entries.m, np.arange(first, last + 1)
    table, sheave = blocks[: array_layout.CONTACT * m].reshape(array_layout.CONTACT, m), m - 1
    for c in range(2):
        for d in range(2):
            for side in range(-2, 3):
                entries.add(c * m + nodes, d * m + nodes + side, table[4 * (side + 2) + 2 * c + d, nodes])
            column, row = table[array_layout.COLUMNS + 2 * c + d, nodes], table[array_layout.ROWS + 2 * d + c, nodes]
            entries.add(c * m + nodes, np.full(len(nodes), d * m + sheave), column)
            entries.add(np.full(len(nodes), d * m + sheave), c * m + nodes, row)
            corner = blocks[array_layout.CONTACT * m + 2 * c + d : array_layout.CONTACT * m + 2 * c + d + 1]
            entries.add(np.array([c * m + sheave]), np.array([d * m + sheave]), corner)
