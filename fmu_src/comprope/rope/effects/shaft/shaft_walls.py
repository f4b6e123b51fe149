"""Walls beside the rope: planes outside of both sides over a range of heights, such as a shaft's wall, a bracket or a guard.

At a node with outward displacement u beyond the wall's distance, per length of rope and with the depth d = u - distance,

    P = max(0, k d + c d / (d + FADE) dd/dt)  inward,   F = -mu P v / sqrt(v^2 + SLOW^2)  along the wall,

so that damping does not switch on at first touch. Over one element at either end of the range the wall fades in.
It moves with the building by `shaft.walls_follow`.
"""

from math import copysign, sqrt

from ....kernels.jit import kernel
from ....quantities import quantity
from ...mechanics.contact.contact_law import unilateral_law
from ...mechanics.wall_motion import wall_motion
from ...parameters.parameter_vector import CAR_WALL, CAR_WALL_V, COUNTERWEIGHT_WALL, COUNTERWEIGHT_WALL_V, ELEMENT, R, slot
from ...runtime.array_layout import DXX, DYY
from ..base import Effect, acts, register

FADE = 1e-4  # m, depth over which the damping fades in, as that of the groove
SLOW = 0.02  # m/s, regularisation of the friction, as in the groove


class ShaftWalls(Effect):
    """Walls, brackets or guards that the rope may touch."""

    name = "shaft_walls"
    hypothesis = False
    stiffness: float = quantity("N/m2", "force per length and depth", 0.0, 1e10, nominal=1e5, off=0.0)
    damping: float = quantity("N.s/m2", "force per length and rate of the depth", 0.0, 1e7, default=0.0, nominal=100.0)
    friction_coefficient: float = quantity("1", "Coulomb friction of the rope along the wall", 0.0, 2.0, default=0.2)
    distance: float = quantity("m", "outward distance from the vertical through the sheave's side", 0.0, 20.0, default=0.3)
    bottom: float = quantity("m", "height at which it begins", -20.0, 1000.0, default=-20.0, nominal=10.0)
    top: float = quantity("m", "height at which it ends", -20.0, 1000.0, default=1000.0)


register(ShaftWalls)
STIFFNESS = slot("effects.shaft_walls.stiffness")
DAMPING = slot("effects.shaft_walls.damping")
MU = slot("effects.shaft_walls.friction_coefficient")
DISTANCE = slot("effects.shaft_walls.distance")
BOTTOM = slot("effects.shaft_walls.bottom")
TOP = slot("effects.shaft_walls.top")


@kernel
def wall_share(p, height):
    """Share of an element's length [m] at a height that has the wall beside it."""
    l = p[ELEMENT]
    below, above = (height - p[BOTTOM]) / l, (p[TOP] - height) / l
    return l * min(max(below, 0.0), 1.0) * min(max(above, 0.0), 1.0)


@kernel
def wall_law(p, depth, rate):
    """Force per length [N/m] of a wall, and its derivatives by depth and by rate."""
    return unilateral_law(p[STIFFNESS], p[DAMPING], FADE, depth, rate)


@kernel
def press(n, t, p, q, v, w, f):
    """Add the walls' forces on all inner nodes."""
    if p[STIFFNESS] == 0.0 and p[DAMPING] == 0.0:
        return 0.0
    m, power = n + 1, 0.0
    walls = p[CAR_WALL], p[CAR_WALL_V], p[COUNTERWEIGHT_WALL], p[COUNTERWEIGHT_WALL_V]
    for i in range(1, n - 1):
        moved, rate = wall_motion(n, q, i, walls)
        side = copysign(1.0, q[m + i])
        depth = side * (q[m + i] - moved) - p[R] - p[DISTANCE]
        if depth > 0.0:
            share = wall_share(p, -q[i])
            force = share * wall_law(p, depth, side * (v[m + i] - rate))[0]
            drag = p[MU] * force * v[i] / sqrt(v[i] * v[i] + SLOW * SLOW)
            f[m + i] -= side * force
            f[i] -= drag
            power -= side * force * v[m + i] + drag * v[i]
    return power


@kernel
def press_tangent(n, t, p, q, v, w, A, weights):
    """Stiffness and damping across the wall, and friction's by velocity along it; how friction grows with depth is left out."""
    if p[STIFFNESS] == 0.0 and p[DAMPING] == 0.0:
        return
    m = n + 1
    walls = p[CAR_WALL], p[CAR_WALL_V], p[COUNTERWEIGHT_WALL], p[COUNTERWEIGHT_WALL_V]
    for i in range(1, n - 1):
        moved, rate = wall_motion(n, q, i, walls)
        side = copysign(1.0, q[m + i])
        depth = side * (q[m + i] - moved) - p[R] - p[DISTANCE]
        if depth > 0.0:
            share = wall_share(p, -q[i])
            force, by_depth, by_rate = wall_law(p, depth, side * (v[m + i] - rate))
            root = 1.0 / sqrt(v[i] * v[i] + SLOW * SLOW)
            A[DYY * m + i] += share * (weights.ck * by_depth + weights.cc * by_rate)
            A[DXX * m + i] += weights.cc * share * p[MU] * force * SLOW * SLOW * root * root * root


acts(ShaftWalls, forces=press, tangents=press_tangent)
