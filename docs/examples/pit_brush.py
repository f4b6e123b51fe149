"""A brush in the pit that damps the lateral motion of the rope: per metre of rope, f = -damping v_y below a height."""

from comprope.effect import Effect, acts, kernel, quantity, register, slot, work


class PitBrush(Effect):
    """A brush around the rope in the pit."""

    name = "pit_brush"
    damping: float = quantity("N.s/m2", "force per length of rope and lateral velocity", 0.0, 100.0, nominal=1.0, off=0.0)
    top: float = quantity("m", "height of the brush's upper edge above the bottom landing", -20.0, 100.0, default=0.5)


register(PitBrush)
DAMPING = slot("effects.pit_brush.damping")
TOP = slot("effects.pit_brush.top")
LENGTH = slot("derived.element")


@kernel
def brush(n, t, p, q, v, w, f):
    """Add the force on every node in the brush and return its power."""
    m, c, power = n + 1, p[DAMPING] * p[LENGTH], 0.0
    for i in range(1, n - 1):
        if -q[i] < p[TOP]:
            f[m + i] -= c * v[m + i]
            power -= c * v[m + i] * v[m + i]
    return power


@kernel
def brush_tangent(n, t, p, q, v, w, A, weights):
    """Subtract cc times the derivative of this force with respect to velocity."""
    cc = weights.cc
    for i in range(1, n - 1):
        if -q[i] < p[TOP]:
            A[work.DYY * (n + 1) + i] += cc * p[DAMPING] * p[LENGTH]


acts(PitBrush, forces=brush, tangents=brush_tangent)
