"""A stiff spring at the rope in the pit, without tangents, and a force that is none where the car is high."""

from math import sqrt

from comprope.effect import Effect, acts, kernel, quantity, register, slot


class PitSpring(Effect):
    """Pulls the rope to the vertical through the sheave's side."""

    name = "pit_spring"
    stiffness: float = quantity("N/m2", "force per length of rope and displacement", 0.0, 1e7, nominal=1e3, off=0.0)


class Root(Effect):
    """A force on the sheave that is not a number while the car is above 22 m."""

    name = "root"
    size: float = quantity("N", "its size", 0.0, 10.0, nominal=1.0, off=0.0)


register(PitSpring)
register(Root)
STIFFNESS = slot("effects.pit_spring.stiffness")
SIZE = slot("effects.root.size")
RADIUS = slot("sheave.radius")
LENGTH = slot("derived.element")


@kernel
def hold(n, t, p, q, v, w, f):
    """Force and power at every node between the bottom landing and a metre above."""
    m, power = n + 1, 0.0
    for i in range(1, n - 1):
        if -1.0 < q[i] < 0.0:
            side = p[RADIUS] if q[m + i] > 0.0 else -p[RADIUS]
            force = -p[STIFFNESS] * p[LENGTH] * (q[m + i] - side)
            f[m + i] += force
            power += force * v[m + i]
    return power


@kernel
def lift(n, t, p, q, v, w, f):
    """Lift the sheave."""
    if p[SIZE] == 0.0:
        return 0.0
    force = p[SIZE] * sqrt(22.0 + q[0])
    f[n] -= force
    return -force * v[n]


acts(PitSpring, forces=hold)
acts(Root, forces=lift)
