"""What the shaft does to the rope: gravity, air, a brush and a wall."""

import math

from .jit import kernel
from .sheave import slope
from .tower import GRAVITY


@kernel
def gravity(n, mass, f):
    """Add the weight of every node."""
    for i in range(n):
        f[2 * i] += mass[i] * GRAVITY


@kernel
def air(p, n, W, q, v, car_velocity, by):
    """Add the drag across the rope, -1/2 rho C_d d |v_n| v_n per length, in air that moves outward with the car."""
    S, f, A = W.S, W.f, W.A
    half = 0.5 * p.air_density * p.drag * p.diameter * p.element
    wind = p.crossflow * car_velocity
    for i in range(1, n - 1):
        hx, hy = -(S[i - 1, 1] + S[i, 1]), S[i - 1, 0] + S[i, 0]
        size = math.sqrt(hx * hx + hy * hy)
        hx, hy = hx / size, hy / size
        blow = wind if q[2 * i + 1] > 0.0 else -wind
        vn = hx * v[2 * i] + hy * (v[2 * i + 1] - blow)
        f[2 * i] -= half * abs(vn) * vn * hx
        f[2 * i + 1] -= half * abs(vn) * vn * hy
        if by.tangent:
            c = 2.0 * half * abs(vn) * by.cc
            A[2 * i, 5] += c * hx * hx
            A[2 * i, 6] += c * hx * hy
            A[2 * i + 1, 4] += c * hx * hy
            A[2 * i + 1, 5] += c * hy * hy


@kernel
def shaft_contact(p, n, W, q, v, by):
    """Add the brush (0.2 m high, springy both ways) and the wall (1 m high, rubbed from one side)."""
    f, A = W.f, W.A
    for i in range(1, n - 1):
        side = 1.0 if q[2 * i + 1] > 0.0 else -1.0
        x, out, speed = q[2 * i], side * q[2 * i + 1] - p.radius, side * v[2 * i + 1]
        if side == p.brush_side and abs(x + p.brush_height) < 0.1:
            k, c = p.brush_stiffness * p.element / 0.2, p.brush_damping * p.element / 0.2
            f[2 * i + 1] -= side * (k * out + c * speed)
            A[2 * i + 1, 5] += (by.ck * k + by.cc * c) if by.tangent else 0.0
        pressed = p.wall_distance - out
        if side == p.wall_side and abs(x + p.wall_height) < 0.5 and pressed > 0.0:
            k = p.wall_stiffness * p.element
            rub = p.wall_friction * k * pressed * slope(v[2 * i], 0.02)
            f[2 * i + 1] += side * k * pressed
            f[2 * i] -= rub * v[2 * i]
            if by.tangent:
                A[2 * i, 5] += by.cc * rub
                A[2 * i + 1, 5] += by.ck * k
