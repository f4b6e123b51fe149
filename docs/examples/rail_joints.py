"""Lateral displacement of the car at the joints of its guide rails.

Each joint displaces the end of the rope towards the counterweight side, y = kick ((1 + cos(k z)) / 2)^2 with k = 2 pi / spacing,
where z is the car's height: `kick` at a joint, zero half-way between two.
"""

from math import cos, pi, sin

from comprope.effect import Effect, acts, kernel, quantity, register, slot


class RailJoints(Effect):
    """Joints of the car's guide rails."""

    name = "rail_joints"
    probes = {"spacing": (2.5, 5.0)}
    kick: float = quantity("m", "lateral displacement of the car at a joint", 0.0, 0.1, nominal=0.005, off=0.0)
    spacing: float = quantity("m", "distance of the joints", 0.5, 20.0, default=2.5)


register(RailJoints)
KICK = slot("effects.rail_joints.kick")
SPACING = slot("effects.rail_joints.spacing")


@kernel
def sway(n, t, p, q, v, a):
    """Displace the end under the car, node 0, with velocity and acceleration."""
    k = 2.0 * pi / p[SPACING]
    angle, rate, change = -k * q[0], -k * v[0], -k * a[0]
    c, s = cos(angle), sin(angle)
    y, by_angle, twice = 0.25 * (1.0 + c) ** 2, -0.5 * (1.0 + c) * s, 0.5 * (s * s - c - c * c)
    q[n + 1] += p[KICK] * y
    v[n + 1] += p[KICK] * by_angle * rate
    a[n + 1] += p[KICK] * (by_angle * change + twice * rate * rate)


acts(RailJoints, ends=sway)
