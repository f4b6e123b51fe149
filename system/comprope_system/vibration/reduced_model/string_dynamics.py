"""Reduced model of one side of the rope: a string of variable length, tension and speed, in finite elements.

The side hangs from its end down to the axle. With s the height above the axle, L(t) the side's length, v the rope's speed
up, xi = s / L, a string of mass rho per length that runs through space with its end obeys

    rho D2y/Dt2 + c Dy/Dt = (T y')',   D/Dt = d/dt + (v / L)(1 - xi) d/dxi,   T = N + rho v^2 + rho (g + v') s

N = half the weight on the axle, plus half the forces that accelerate the sheave: (J / r^2 + rho pi r) times half the
difference of the accelerations of both ends (rotation), (m + rho pi r) times half their sum (translation). The contact force
does not depend on the speed. Due to its bending stiffness the rope is displaced at the height of the axle by

    b = EI / (2 r N) (g0 + g1 v + g2 v^2 + g3 sgn v)

where g0 is near 1, g1 about -D / (EI sqrt(EI / N)) for a bending damping D, which delays the
straightening of rope leaving the sheave, and g3 zero without bending hysteresis; `calibration.py` determines them with the full
model. The rope is excited by b, which depends on speed and acceleration, and by the change of tension. With
y = b at the axle and 0 at the end the weak form gives, per rho L, with the constant matrices of `finite_elements.py`

    M y'' + (2 (v/L) G + c/rho M) y' + (N/(rho L^2) K + (v/L)^2 (K - S) + (g + v')/L H + (v' + c/rho v)/L G) y = 0

Neglected: vertical vibration of the sheave, tension due to lateral motion, bending away from the sheave, effects other than
external damping. Valid only if the rope wraps the sheave, N r^2 > EI / 2.
"""

from dataclasses import dataclass
from math import pi

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from comprope.errors import InputError
from comprope.rope.parameters import Base

from .finite_elements import ELEMENTS, dense, matrices, nodes

Floats = NDArray[np.float64]

FRICTION_TRANSITION_SPEED = 0.02  # m/s: below it internal friction of the rope has not reversed yet


@dataclass(frozen=True)
class StringParameters:
    """Parameters of one side of the rope: mass per length [kg/m], weight on the groove of a side [N], force per
    acceleration for rotation and for translation of the sheave [kg], bending stiffness [N m2], radius [m], damping / mass
    [1/s], gravity [m/s2]; `offset_coefficients`: g0 ... g3.
    """

    mass_per_length: float
    weight: float
    rotating_mass: float
    vertical_mass: float
    bending_stiffness: float
    radius: float
    damping: float
    gravity: float
    offset_coefficients: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    def offset_at(self, groove_force: Floats, speed: Floats) -> Floats:
        """Outward offset of the rope at the axle's height [m] for a contact force `groove_force` [N] and upward `speed` [m/s]."""
        g0, g1, g2, g3 = self.offset_coefficients
        return (
            self.bending_stiffness
            / (2.0 * self.radius * groove_force)
            * (g0 + g1 * speed + g2 * speed**2 + g3 * np.tanh(speed / FRICTION_TRANSITION_SPEED))
        )

    @property
    def bending_length(self) -> float:
        """Bending length [m]: sqrt(EI / N)."""
        return float((self.bending_stiffness / self.weight) ** 0.5)

    @property
    def offset(self) -> float:
        """Static outward offset of the rope at the height of the axle [m]."""
        return float(self.offset_at(np.array(self.weight), np.array(0.0)))


def string_parameters(model: Base) -> StringParameters:
    """A side of the model's rope; raises `InputError` where the sheave is too light for the rope to wrap it."""
    rope, sheave, g = model.rope, model.sheave, model.shaft.gravity
    wrapped = rope.mass_per_length * pi * sheave.radius
    weight, least = 0.5 * g * (sheave.mass_per_rope + wrapped), rope.bending_stiffness / (2.0 * sheave.radius**2)
    if weight <= least:
        wraps = sheave.ropes * (2.0 * least / g - wrapped)
        raise InputError(
            f"sheave.mass = {sheave.mass:g} kg: more than {wraps:.4g} kg is accepted for tuning; a lighter "
            "sheave hangs in a free loop of rope, for which the reduced model is not valid"
        )
    rotating_mass = 0.5 * (sheave.inertia_per_rope / sheave.radius**2 + wrapped)
    vertical_mass = 0.5 * (sheave.mass_per_rope + wrapped)
    damping = rope.external_damping / rope.mass_per_length
    return StringParameters(
        rope.mass_per_length, weight, rotating_mass, vertical_mass, rope.bending_stiffness, sheave.radius, damping, g
    )


def standstill_modes(rope: StringParameters, length: float) -> tuple[Floats, Floats, Floats]:
    """Modes at standstill: squares of the angular frequencies (k,), shapes (n - 1, k) at the inner nodes, stiffness over rho L.

    The modes have unit mass and are sorted by increasing frequency.
    """
    M = matrices()
    stiffness = rope.weight / rope.mass_per_length / length**2 * M.K + rope.gravity / length * M.H
    squares, modes = eigh(dense(stiffness), dense(M.mass))
    return squares, modes, stiffness


def rest_shape(rope: StringParameters, length: Floats, xi: Floats) -> Floats:
    """Static outward shape (m, n) [m] at coordinates xi (n,) for lengths (m,) [m]: (T y')' = 0."""
    slack = rope.mass_per_length * rope.gravity * np.asarray(length)[:, None] / rope.weight
    return np.asarray(rope.offset * (1.0 - np.log1p(slack * xi) / np.log1p(slack)))


def simulate_string(
    rope: StringParameters, dt: float, length: Floats, speed: Floats, acceleration: Floats, groove_force: Floats
) -> Floats:
    """Outward displacement at the nodes (m, n + 1) [m] at time steps `dt` [s], starting from rest.

    `length` [m], `speed` and `acceleration` of the end, up positive [m/s, m/s2], `groove_force` [N] on the groove, each (m,).
    """
    M, b = matrices(), rope.offset_at(groove_force, speed)
    found = np.zeros((len(length), ELEMENTS + 1))
    found[0] = rest_shape(rope, length[:1], nodes())[0] * b[0] / rope.offset
    found[:, 0] = b
    motion = np.array([length, speed, acceleration, groove_force / rope.mass_per_length])
    _integrate(dt, motion, rope.gravity, rope.damping, M, found)
    return found


@numba.njit(cache=True)
def _integrate(dt, motion, g, c, M, found):  # type: ignore[no-untyped-def]
    """Fill the rows of `found` after the first by the implicit midpoint rule on y and the momenta p = mass y', so that b need not
    be smooth; the band is solved by forward elimination and back substitution. `motion` (4, m): L, v, v', N / rho.
    """
    L, v, a, N = motion
    mass, G, S, K, H = M
    h, k = 0.5 * dt, mass.shape[1]
    p, u, slope, stiff = np.zeros(k), np.zeros(k + 2), np.zeros(k + 1), np.zeros(3)
    for i in range(len(L) - 1):
        y, length, speed, up = found[i], 0.5 * (L[i] + L[i + 1]), 0.5 * (v[i] + v[i + 1]), 0.5 * (a[i] + a[i + 1])
        n, rate = 0.5 * (N[i] + N[i + 1]) / length**2, speed / length
        drift, gravity, level = up / length + c * rate, (g + up) / length, n + rate**2
        u[0] = (found[i + 1, 0] - y[0]) / dt
        for j in range(k):
            push = p[j]
            for m in range(3):
                stiff[m] = level * K[m, j] - rate**2 * S[m, j] + gravity * H[m, j] + drift * G[m, j]
                push -= h * stiff[m] * y[j + m]
                stiff[m] = (1.0 + h * c) * mass[m, j] + 2.0 * h * rate * G[m, j] + h * h * stiff[m]
            pivot = stiff[1] - stiff[0] * slope[j]
            slope[j + 1], u[j + 1] = stiff[2] / pivot, (push - stiff[0] * u[j]) / pivot
        for j in range(k - 1, 0, -1):
            u[j] -= slope[j] * u[j + 1]
        for j in range(k):
            found[i + 1, j + 1] = y[j + 1] + dt * u[j + 1]
            p[j] = 2.0 * (mass[0, j] * u[j] + mass[1, j] * u[j + 1] + mass[2, j] * u[j + 2]) - p[j]
