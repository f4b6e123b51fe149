"""A hanging rope with a mass free at its lower end, without sheave, from the same kernels as the rope on its sheave.

Tension, bending, their tangent, the elimination and Newmark's rule are the product's own; this module adds what
the product has no use for: an end that moves freely, and an upper end that is led sideways.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np

from comprope.rope.integration import newmark
from comprope.rope.linalg import block_band
from comprope.rope.mechanics import internal_forces, internal_tangent
from comprope.rope.parameters.parameter_vector import vector
from comprope.rope.runtime import array_layout
from comprope.rope.runtime.kernel_arguments import Motion

from ...vibration.prescribed_trip import Floats

TOLERANCE = 1e-10  # m, the last correction
ITERATIONS = 20


@dataclass(frozen=True)
class Hanging:
    """A rope of length [m] in `elements`, with a mass [kg] at its lower end; mass per length, EA, EI, gravity in SI."""

    elements: int
    length: float = 50.0
    mass: float = 60.0
    mass_per_length: float = 1.2
    axial_stiffness: float = 1e7
    bending_stiffness: float = 20.0
    gravity: float = 9.81

    @property
    def parameters(self) -> Floats:
        """The kernels' parameter vector; Newmark's rule is the paper's, without numerical damping."""
        return np.array(
            vector(
                {
                    "shaft.gravity": self.gravity,
                    "rope.mass_per_length": self.mass_per_length,
                    "rope.axial_stiffness": self.axial_stiffness,
                    "rope.bending_stiffness": self.bending_stiffness,
                    "solver.numerical_damping": 0.0,
                    "derived.element": self.length / self.elements,
                }
            )
        )


EndMotion = Callable[[float], tuple[float, float, float]]  # from time to position, velocity, acceleration of the upper end


def lead_sine(time: float, amplitude: float = 0.05, frequency: float = 0.2) -> tuple[float, float, float]:
    """Sideways motion amplitude sin(2 pi frequency t) [m, m/s, m/s2]; it begins with its full velocity."""
    w = 2.0 * pi * frequency
    return amplitude * np.sin(w * time), amplitude * w * np.cos(w * time), -amplitude * w * w * np.sin(w * time)


class FreeRope:
    """The rope in motion: q, v, a hold x (down) and y of n nodes, each with a column to spare, as the kernels have it."""

    def __init__(self, rope: Hanging, lead: EndMotion) -> None:
        self.rope, self.lead, self.p = rope, lead, rope.parameters
        self.n = rope.elements + 1
        m, self.element = self.n + 1, rope.length / rope.elements
        self.q, self.v, self.a, self.f, self.r = (np.zeros(2 * m) for _ in range(5))
        self.w, self.A, self.L = (np.zeros(size * m) for size in (array_layout.SECTIONS, array_layout.BAND, block_band.FACTOR))
        self.counters = np.zeros(newmark.COUNTERS)
        self.masses = np.full(self.n, rope.mass_per_length * self.element)
        self.masses[-1] = rope.mass + 0.5 * rope.mass_per_length * self.element
        below = np.cumsum(self.masses[::-1])[::-1]
        stretch = below[1:] * rope.gravity / rope.axial_stiffness
        self.q[1 : self.n] = np.cumsum(self.element * (1.0 + stretch))
        self.q[m], self.v[m], self.a[m] = lead(0.0)

    def step(self, time: float, h: float) -> None:
        """Advance to `time` [s] by one step of length h [s]; raises `ArithmeticError` where it does not converge."""
        n, m = self.n, self.n + 1
        motion = Motion(self.q, self.v, self.a)
        newmark.predict(n, h, Motion(*(one.copy() for one in motion)), motion)
        self.q[m], self.v[m], self.a[m] = self.lead(time)
        for _ in range(ITERATIONS):
            self._residual()
            self._solve(h)
            if newmark.correct(n, self.p, newmark.time_rule(self.p, False), h, self.r, motion, self.counters) < TOLERANCE:
                return
        raise ArithmeticError(f"no convergence at t = {time:g} s")

    def _residual(self) -> None:
        """r = f - M a; none at the upper end."""
        n, m = self.n, self.n + 1
        internal_forces.stretch(n, self.p, self.q, self.v, self.w)
        internal_forces.bend(n, self.p, self.w)
        internal_forces.sum_forces(n, self.p, self.v, self.w, self.f)
        self.f[n - 1] += self.rope.mass * self.rope.gravity
        for s in (0, m):
            self.r[s : s + n] = self.f[s : s + n] - self.masses * self.a[s : s + n]
            self.r[s] = 0.0

    def _solve(self, h: float) -> None:
        """Replace r by the correction of the acceleration."""
        n, ck = self.n, 0.25 * h * h
        internal_tangent.segment_blocks(n, self.p, self.w, ck, 0.5 * h)
        internal_tangent.bending_stiffness(n, self.p, self.w, ck, 0.5 * h)
        internal_tangent.assemble(n, self.p, self.w, self.A, 1.0, 0.5 * h)
        self._ends()
        first, last = n - 3, n - 1
        block_band.factor(n, self.A, self.L, self.r, first, last)
        self._solve_last_nodes(first)
        block_band.back_substitute(n, self.L, self.r, first, last)

    def _ends(self) -> None:
        """Hold the upper end; add to the tangent what the lower one has as a free end."""
        n, m = self.n, self.n + 1
        A, w = self.A.reshape(array_layout.BAND, m), self.w.reshape(array_layout.SECTIONS, m)
        A[:, 0] = 0.0
        A[[array_layout.DXX, array_layout.DYY], 0] = 1.0
        e, k = n - 2, w[array_layout.BENDING, n - 2]
        own = w[[array_layout.WX, array_layout.WY], e]
        both = w[[array_layout.WX, array_layout.WY], e - 1] + own
        S = np.array([[w[array_layout.SXX, e], w[array_layout.SXY, e]], [w[array_layout.SXY, e], w[array_layout.SYY, e]]])
        end = S + k * np.outer(own, own) + self.masses[-1] * np.eye(2)
        A[[array_layout.DXX, array_layout.DXY, array_layout.DYY], n - 1] = end[0, 0], end[0, 1], end[1, 1]
        A[array_layout.EXX : array_layout.EYY + 1, e] = (-S - k * np.outer(both, own)).ravel()

    def _solve_last_nodes(self, first: int) -> None:
        """Solve the dense rest of the elimination: the last three nodes."""
        m = self.n + 1
        A, rest = self.A.reshape(array_layout.BAND, m), np.zeros((3, 3, 2, 2))
        for k in range(3):
            xx, xy, yy = A[[array_layout.DXX, array_layout.DXY, array_layout.DYY], first + k]
            rest[k, k] = [[xx, xy], [xy, yy]]
        for k, j, base in ((0, 1, array_layout.EXX), (1, 2, array_layout.EXX), (0, 2, array_layout.GXX)):
            rest[k, j] = A[base : base + 4, first + k].reshape(2, 2)
            rest[j, k] = rest[k, j].T
        places = [first, first + m, first + 1, first + 1 + m, first + 2, first + 2 + m]
        self.r[places] = np.linalg.solve(rest.transpose(0, 2, 1, 3).reshape(6, 6), self.r[places])


def swing_sideways(rope: Hanging, step: float, until: float, every: float) -> tuple[Floats, Floats, Floats]:
    """Times [s] and displacements [m] of the middle and the lower end, upper end led by `lead_sine`."""
    moving = FreeRope(rope, lead_sine)
    m, skip = moving.n + 1, round(every / step)
    rows = [(0.0, 0.0, 0.0)]
    for k in range(1, round(until / step) + 1):
        moving.step(k * step, step)
        if k % skip == 0:
            rows.append((k * step, moving.q[m + rope.elements // 2], moving.q[m + rope.elements]))
    time, middle, bottom = np.array(rows).T
    return time, middle, bottom
