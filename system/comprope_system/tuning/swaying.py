"""One side of the rope while the car travels: a string of changing length, tension and speed, in a dozen shape functions.

The side hangs from its end down to the axle. With s the height above the axle, L(t) the side's length, v the rope's speed
up, xi = s / L, a string of mass rho per length that runs through space with its end obeys

    rho D2y/Dt2 + c Dy/Dt = (T y')',   D/Dt = d/dt + (v / L)(1 - xi) d/dxi,   T = N + rho v^2 + rho (g + v') s

N = half the weight on the axle, with half the pulls that turn the sheave and lift it: (J / r^2 + rho pi r) times half the
difference of both ends' accelerations, (m + rho pi r) times half their sum. What presses the rope on the groove does not
depend on the speed. The rope's stiffness holds it off the axle's vertical by

    b = EI / (2 r N) (g0 + g1 v + g2 v^2 + g3 sgn v)

where g0 is near 1, g1 about -D / (EI sqrt(EI / N)) for a bending damping D, which makes rope that runs off the sheave
straighten late, and g3 nought but for bending hysteresis; `calibrate.py` measures them on the full model. So what swings the
rope is b, which follows speed and acceleration, and the tension, which changes its shape. With
y = (1 - xi) b + sum of q_k sqrt(2) sin(k pi xi) the weak form gives, per rho L, with constant matrices over xi

    q'' + (2 (v/L) G + c/rho) q' + (N/(rho L^2) K + (v/L)^2 (K - S) + (g + v')/L H + (v' + c/rho v)/L G) q = - the same of b

Left out: the sheave's bounce, tension from swinging, bending away from the sheave, effects other than external damping.
Unlike the full model it holds only where the rope wraps the sheave, N r^2 > EI / 2.
"""

from dataclasses import dataclass
from functools import cache
from math import pi

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from comprope.errors import InputError
from comprope.rope.parameters import Base

Floats = NDArray[np.float64]

SHAPES = 12
STARTS = 0.02  # m/s: below it friction inside the rope has not turned round yet
_QUADRATURE = 64


@dataclass(frozen=True)
class Rope:
    """What one side of a rope is: mass per length [kg/m], weight on the groove of a side [N], the pull that turns the sheave
    over acceleration [kg], the same that lifts it [kg], bending stiffness [N m2], radius [m], damping over mass [1/s],
    gravity [m/s2]; `held`: g0 ... g3.
    """

    mass_per_length: float
    weight: float
    turning: float
    lifting: float
    bending_stiffness: float
    radius: float
    damping: float
    gravity: float
    held: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    def offset_at(self, press: Floats, speed: Floats) -> Floats:
        """How far outward the rope stands off at the axle's height [m], pressed by `press` [N], running up at `speed` [m/s]."""
        g0, g1, g2, g3 = self.held
        return (
            self.bending_stiffness
            / (2.0 * self.radius * press)
            * (g0 + g1 * speed + g2 * speed**2 + g3 * np.tanh(speed / STARTS))
        )

    @property
    def bending_length(self) -> float:
        """How far its stiffness reaches along the rope from where it is bent [m]: sqrt(EI / N)."""
        return float((self.bending_stiffness / self.weight) ** 0.5)

    @property
    def offset(self) -> float:
        """How far outward the rope stands off at the axle's height, at rest [m]."""
        return float(self.offset_at(np.array(self.weight), np.array(0.0)))


def rope_of(model: Base) -> Rope:
    """A side of the model's rope; raises `InputError` where the sheave is too light for the rope to wrap it."""
    rope, sheave, g = model.rope, model.sheave, model.shaft.gravity
    wrapped = rope.mass_per_length * pi * sheave.radius
    weight, least = 0.5 * g * (sheave.mass + wrapped), rope.bending_stiffness / (2.0 * sheave.radius**2)
    if weight <= least:
        raise InputError(
            f"sheave.mass = {sheave.mass:g} kg: more than {2.0 * least / g - wrapped:.4g} kg is accepted for tuning; a lighter "
            "sheave hangs in a free loop of rope, which the search does not know"
        )
    turning, lifting = 0.5 * (sheave.inertia / sheave.radius**2 + wrapped), 0.5 * (sheave.mass + wrapped)
    damping = rope.external_damping / rope.mass_per_length
    return Rope(rope.mass_per_length, weight, turning, lifting, rope.bending_stiffness, sheave.radius, damping, g)


@dataclass(frozen=True)
class Matrices:
    """The constant matrices over xi: G, S, K, H (k, k) of the shape functions, and columns `lift` (4, k) of the same for b.

    `mass` (k,) is the lift's share of each shape function.
    """

    G: Floats
    S: Floats
    K: Floats
    H: Floats
    lift: Floats
    mass: Floats


@cache
def matrices(count: int = SHAPES) -> Matrices:
    """The matrices of `count` shape functions, by Gauss quadrature exact enough for all of them."""
    nodes, weights = np.polynomial.legendre.leggauss(_QUADRATURE)
    xi, w = 0.5 * (nodes + 1.0), 0.5 * weights
    f, df = shapes(xi, count), slopes(xi, count)
    base, dbase = 1.0 - xi, -np.ones_like(xi)

    def products(of: Floats, to: Floats, factor: Floats) -> Floats:
        return np.ascontiguousarray(of @ (w * factor * to).T)

    columns = [
        products(f, dbase, 1.0 - xi), products(df, dbase, (1.0 - xi) ** 2), products(df, dbase, np.ones_like(xi)),
        products(df, dbase, xi),
    ]  # fmt: skip
    return Matrices(
        products(f, df, 1.0 - xi), products(df, df, (1.0 - xi) ** 2), products(df, df, np.ones_like(xi)), products(df, df, xi),
        np.array(columns), products(f, base, np.ones_like(xi)),
    )  # fmt: skip


def shapes(xi: Floats, count: int = SHAPES) -> Floats:
    """The shape functions (k, n) at places xi (n,)."""
    return np.asarray(np.sqrt(2.0) * np.sin(np.outer(np.arange(1, count + 1), pi * xi)))


def slopes(xi: Floats, count: int = SHAPES) -> Floats:
    """Their derivatives by xi (k, n)."""
    k = np.arange(1, count + 1)[:, None] * pi
    return np.asarray(np.sqrt(2.0) * k * np.cos(k * xi))


def still_modes(rope: Rope, length: float, count: int = SHAPES) -> tuple[Floats, Floats, float, float]:
    """Squares of the angular frequencies (k,) at standstill, modes (k, k) in the shape functions, N/(rho L^2) and g/L [1/s2]."""
    M, press, weight = matrices(count), rope.weight / rope.mass_per_length / length**2, rope.gravity / length
    squares, V = eigh(press * M.K + weight * M.H)
    return squares, V, press, weight


def at_rest(rope: Rope, length: Floats, xi: Floats) -> Floats:
    """The outward shape at rest (m, n) [m] at places xi (n,) of sides as long as `length` (m,) [m]: (T y')' = 0."""
    slack = rope.mass_per_length * rope.gravity * np.asarray(length)[:, None] / rope.weight
    return np.asarray(rope.offset * (1.0 - np.log1p(slack * xi) / np.log1p(slack)))


def sway(
    rope: Rope, dt: float, length: Floats, speed: Floats, acceleration: Floats, press: Floats, count: int = SHAPES
) -> Floats:
    """Amplitudes (m, 1 + k): b and q_1 ... q_k at times `dt` [s] apart, from rest.

    `length` [m], `speed` and `acceleration` of the end, up positive [m/s, m/s2], `press` [N] on the groove, each (m,).
    """
    b = rope.offset_at(press, speed)
    M = matrices(count)
    q = _march(dt, length, speed, acceleration, press / rope.mass_per_length, b, rope.gravity, rope.damping,
               M.G, M.S, M.K, M.H, M.lift, M.mass)  # fmt: skip
    return np.hstack([b[:, None], q])


@numba.njit(cache=True)
def _march(dt, L, v, a, press, b, g, c, G, S, K, H, lift, mass):  # type: ignore[no-untyped-def]
    """q (m, k) by the implicit midpoint rule on q and p = q' + mass b', so that b need not be smooth."""
    k, h = G.shape[0], 0.5 * dt
    carried = G @ mass - lift[0]
    one, q, found = np.eye(k), np.zeros(k), np.zeros((len(L), k))
    stiffness, force = press[0] / L[0] ** 2 * K + g / L[0] * H, press[0] / L[0] ** 2 * lift[2] + g / L[0] * lift[3]
    q[:] = np.linalg.solve(stiffness, -force * b[0])
    p, found[0], inverse, still = np.zeros(k), q, one, False
    for i in range(len(L) - 1):
        length, speed, up = 0.5 * (L[i] + L[i + 1]), 0.5 * (v[i] + v[i + 1]), 0.5 * (a[i] + a[i + 1])
        n, rate = 0.5 * (press[i] + press[i + 1]) / length**2, speed / length
        way = up / length + c * rate
        stiffness = n * K + rate**2 * (K - S) + (g + up) / length * H + way * G
        if not (still and speed == 0.0 and up == 0.0):
            inverse = np.ascontiguousarray(np.linalg.inv((1.0 + h * c) * one + 2.0 * h * rate * G + h * h * stiffness))
            still = speed == 0.0 and up == 0.0
        db, level = (b[i + 1] - b[i]) / dt, 0.5 * (b[i] + b[i + 1])
        force = n * lift[2] + rate**2 * (lift[2] - lift[1]) + (g + up) / length * lift[3] + way * lift[0]
        f = 2.0 * rate * db * carried - force * level
        middle = inverse @ (p + h * (f - stiffness @ (q - h * db * mass)))
        q += dt * (middle - db * mass)
        p = 2.0 * middle - p
        found[i + 1] = q
    return found
