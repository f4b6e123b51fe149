"""Brushes and guides at the rope: what touches it on one side of the shaft over a short range of heights.

With the outward displacement u of the rope from the vertical through the sheave's side,

    brush:  F_y = -(k u + c du/dt), springy and viscous both ways (Kelvin and Voigt's model)
    guide:  P = max(0, k (|push| - sign(push) u)) in the direction of push,  F_x = -mu P v / sqrt(v^2 + SLOW^2) along the rope

The guide presses one way only (unilateral contact with Coulomb friction): with a positive push it stands inside of the rope and
pushes it outward, with a negative one outside. Both are spread over the rope with weights cos^2(pi d / (2 length)), d the
distance from their height, whose sum over nodes is the same wherever these are. They move with the building by
`shaft.walls_follow`.
"""

from math import copysign, cos, pi, sqrt
from typing import ClassVar

from ....kernels.jit import kernel
from ....quantities import quantity
from ...mechanics.wall_motion import wall_motion
from ...parameters.parameter_vector import CAR_WALL, CAR_WALL_V, COUNTERWEIGHT_WALL, COUNTERWEIGHT_WALL_V, ELEMENT, R, slot
from ...runtime.array_layout import DXX, DYY
from ..base import Effect, acts, register

SLOW = 0.02  # m/s, regularisation of the friction, as in the groove
SIDES = (1.0, -1.0)


class RopeBrush(Effect):
    """Brush or damper that holds the rope sideways at a height."""

    name = "rope_brush"
    proportional = True
    probes: ClassVar[dict[str, tuple[float, ...]]] = {"side": SIDES}
    stiffness: float = quantity("N/m", "lateral force per displacement of the rope", 0.0, 1e6, nominal=20.0, off=0.0)
    damping: float = quantity("N.s/m", "lateral force per velocity of the rope", 0.0, 1e6, default=0.0, nominal=5.0)
    height: float = quantity("m", "height of its middle", -20.0, 1000.0, default=0.5)
    side: float = quantity("1", "on the counterweight's side (positive) or the car's (negative)", -1.0, 1.0, default=1.0)
    length: float = quantity("m", "length of rope over which it acts", 0.05, 20.0, default=0.2)


class RopeGuide(Effect):
    """Guide, bracket or wall that the rope rubs against at a height."""

    name = "rope_guide"
    proportional = True
    probes: ClassVar[dict[str, tuple[float, ...]]] = {"side": SIDES, "push": (0.02, -0.02)}
    stiffness: float = quantity("N/m", "force per displacement of the rope", 0.0, 1e8, nominal=100.0, off=0.0)
    push: float = quantity(
        "m", "outward displacement of the rope at which it just touches; the guide stands inside if positive, else outside",
        -5.0, 5.0, default=0.02,
    )  # fmt: skip
    friction_coefficient: float = quantity("1", "Coulomb friction of the rope along the guide", 0.0, 2.0, default=0.2)
    height: float = quantity("m", "height of its middle", -20.0, 1000.0, default=0.5)
    side: float = quantity("1", "on the counterweight's side (positive) or the car's (negative)", -1.0, 1.0, default=1.0)
    length: float = quantity("m", "length of rope over which it acts", 0.05, 20.0, default=1.0)


register(RopeBrush)
register(RopeGuide)
BRUSH_STIFFNESS, BRUSH_DAMPING, BRUSH_HEIGHT, BRUSH_SIDE, BRUSH_LENGTH = (
    slot(f"effects.rope_brush.{name}") for name in ("stiffness", "damping", "height", "side", "length")
)
GUIDE_STIFFNESS, PUSH, GUIDE_MU, GUIDE_HEIGHT, GUIDE_SIDE, GUIDE_LENGTH = (
    slot(f"effects.rope_guide.{name}") for name in ("stiffness", "push", "friction_coefficient", "height", "side", "length")
)


@kernel
def share(p, x, y, height, side, length):
    """Share of a brush or guide that a node of the rope at (x, y) meets; zero on the other side and away from its height."""
    reach = max(length, p[ELEMENT])
    away = abs(-x - height) / reach
    if away >= 1.0 or side * y <= 0.0:
        return 0.0
    c = cos(0.5 * pi * away)
    return c * c * p[ELEMENT] / reach


@kernel
def brush(n, t, p, q, v, w, f):
    """Add the brush's forces on all inner nodes."""
    if p[BRUSH_STIFFNESS] == 0.0 and p[BRUSH_DAMPING] == 0.0:
        return 0.0
    m, power = n + 1, 0.0
    walls = p[CAR_WALL], p[CAR_WALL_V], p[COUNTERWEIGHT_WALL], p[COUNTERWEIGHT_WALL_V]
    for i in range(1, n - 1):
        part = share(p, q[i], q[m + i], p[BRUSH_HEIGHT], p[BRUSH_SIDE], p[BRUSH_LENGTH])
        if part > 0.0:
            moved, rate = wall_motion(n, q, i, walls)
            out = q[m + i] - moved - copysign(p[R], q[m + i])
            force = part * (p[BRUSH_STIFFNESS] * out + p[BRUSH_DAMPING] * (v[m + i] - rate))
            f[m + i] -= force
            power -= force * v[m + i]
    return power


@kernel
def brush_tangent(n, t, p, q, v, w, A, weights):
    """Stiffness and damping of the brush; how its share changes with height is left out."""
    if p[BRUSH_STIFFNESS] == 0.0 and p[BRUSH_DAMPING] == 0.0:
        return
    m, k = n + 1, weights.ck * p[BRUSH_STIFFNESS] + weights.cc * p[BRUSH_DAMPING]
    for i in range(1, n - 1):
        A[DYY * m + i] += k * share(p, q[i], q[m + i], p[BRUSH_HEIGHT], p[BRUSH_SIDE], p[BRUSH_LENGTH])


@kernel
def pressure(p, out):
    """Outward force per stiffness [m] of the guide on a rope that is `out` from the middle: zero where it does not touch."""
    sense = copysign(1.0, p[PUSH])
    return sense * max(0.0, abs(p[PUSH]) - sense * (out - p[R]))


@kernel
def guide(n, t, p, q, v, w, f):
    """Add the guide's forces and friction on all inner nodes."""
    if p[GUIDE_STIFFNESS] == 0.0:
        return 0.0
    m, power = n + 1, 0.0
    walls = p[CAR_WALL], p[CAR_WALL_V], p[COUNTERWEIGHT_WALL], p[COUNTERWEIGHT_WALL_V]
    for i in range(1, n - 1):
        part = share(p, q[i], q[m + i], p[GUIDE_HEIGHT], p[GUIDE_SIDE], p[GUIDE_LENGTH])
        if part > 0.0:
            moved, _ = wall_motion(n, q, i, walls)
            side = copysign(1.0, q[m + i])
            force = side * p[GUIDE_STIFFNESS] * part * pressure(p, side * (q[m + i] - moved))
            drag = p[GUIDE_MU] * abs(force) * v[i] / sqrt(v[i] * v[i] + SLOW * SLOW)
            f[m + i] += force
            f[i] -= drag
            power += force * v[m + i] - drag * v[i]
    return power


@kernel
def guide_tangent(n, t, p, q, v, w, A, weights):
    """Stiffness where it touches and friction's by velocity; changes of friction with depth and of the share are left out."""
    if p[GUIDE_STIFFNESS] == 0.0:
        return
    m = n + 1
    walls = p[CAR_WALL], p[CAR_WALL_V], p[COUNTERWEIGHT_WALL], p[COUNTERWEIGHT_WALL_V]
    for i in range(1, n - 1):
        k = p[GUIDE_STIFFNESS] * share(p, q[i], q[m + i], p[GUIDE_HEIGHT], p[GUIDE_SIDE], p[GUIDE_LENGTH])
        moved, _ = wall_motion(n, q, i, walls)
        depth = abs(pressure(p, copysign(1.0, q[m + i]) * (q[m + i] - moved)))
        if k > 0.0 and depth > 0.0:
            root = 1.0 / sqrt(v[i] * v[i] + SLOW * SLOW)
            A[DYY * m + i] += weights.ck * k
            A[DXX * m + i] += weights.cc * p[GUIDE_MU] * k * depth * SLOW * SLOW * root * root * root


acts(RopeBrush, forces=brush, tangents=brush_tangent)
acts(RopeGuide, forces=guide, tangents=guide_tangent)
