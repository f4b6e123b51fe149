"""The tower at rest: the shape that balances weight, tension, bending and contact, without friction."""

import math

import numpy as np

from .arguments import Ambience, Rope, Weights, Work
from .equations_of_motion import correction, forces
from .jit import entry
from .tower import GRAVITY, Floats, Tower


@entry
def solve_equilibrium(p, n, W, rope, q, v):
    """Newton's iteration with a mass that vanishes with the imbalance; the sheave does not turn. Returns the last correction."""
    N = 2 * n
    first = size = 0.0
    for _ in range(400):
        cm = 1e6 if first == 0.0 else 1e6 * (size / first)
        forces(p, n, W, rope, Ambience(0.0, 0.0), q, v, Weights(1.0, 0.0, cm, True))
        W.f[N + 1] = 0.0
        W.D[1, 1] = 1e12
        size = 0.0
        for k in range(N + 2):
            W.x[5 + k] = W.f[k]
        for k in range(2, N - 2):
            size = max(size, abs(W.f[k]))
        size = max(size, abs(W.f[N]))
        first = max(first, size)
        largest = correction(n, W, True)
        share = min(1.0, 0.02 / largest) if largest > 0.0 else 1.0
        for k in range(N + 2):
            q[k] += share * W.x[5 + k]
        if largest < 1e-11 or (largest < 1e-9 and size < 1e-6):
            return largest
    return largest


def initial_guess(p: Tower, n: int, car: float, offsets: tuple[float, float]) -> Floats:
    """Straight sides, stretched by their weight, and an arc; q [2 n + 2] with the car's end at height `car`."""
    T0, w = 0.5 * p.sheave_mass * GRAVITY, p.mass_per_length * GRAVITY
    arc = math.pi * p.radius

    def stretched(s: Floats | float) -> Floats | float:
        return s + (T0 * s + 0.5 * w * s * s) / p.EA  # height above the axle of the rope's metre s

    axle = p.pit
    for _ in range(50):
        heights = np.array([axle + car, axle + p.height - car])
        natural = heights - (T0 * heights + 0.5 * w * heights**2) / p.EA
        axle += 0.5 * (p.rope_length - arc * (1.0 - T0 / p.EA) - natural.sum())
    s = np.arange(n) * p.element
    left, right = natural[0], p.rope_length - natural[1]
    angle = np.pi * np.clip((s - left) / (right - left), 0.0, 1.0)
    r = p.radius - T0 / p.radius / p.contact_stiffness
    up = np.where(s < left, stretched(left - s), np.where(s > right, stretched(s - right), 0.0))
    x = axle - up + r * np.sin(angle)
    y = -r * np.cos(angle)
    q = np.zeros(2 * n + 2)
    q[0 : 2 * n : 2], q[1 : 2 * n : 2], q[2 * n] = x, y, axle
    q[0:2] = -car, -(p.radius + offsets[0])
    q[2 * n - 2 : 2 * n] = -(p.height - car), p.radius + offsets[1]
    return q


def static_equilibrium(p: Tower, n: int, W: Work, mass: Floats, car: float, offsets: tuple[float, float]) -> Floats:
    """The state at rest, with the ends `offsets` [m] outside the sheave's sides."""
    q = initial_guess(p, n, car, offsets)
    still = p._replace(friction=0.0, dahl_moment=0.0, drag=0.0)
    left = solve_equilibrium(still, n, W, Rope(mass, np.zeros(n), np.zeros(n)), q, np.zeros_like(q))
    if not left < 1e-8:
        raise RuntimeError(f"the rope found no rest: the last correction was {left:.1e} m")
    return q
