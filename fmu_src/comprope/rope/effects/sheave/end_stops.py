"""End stops of the sheave's guides: springs that the axle meets when it has travelled up or down by their gaps.

With the depth d of the axle in a stop, F = max(0, k d + c d / (d + FADE) dd/dt), so that the damping does not switch on at first
touch. A stop pushes only.
"""

from ....kernels.jit import kernel
from ....quantities import quantity
from ...mechanics.contact.contact_law import unilateral_law
from ...parameters.parameter_vector import PIT, slot
from ...runtime.array_layout import DXX
from ..base import Effect, acts, register

FADE = 1e-4  # m, depth over which the damping of a stop fades in, as that of the rope's contact


class EndStops(Effect):
    """End stops of the sheave's vertical travel."""

    name = "end_stops"
    hypothesis = False
    stiffness: float = quantity("N/m", "stiffness of each stop, one rope's share", 0.0, 1e10, nominal=5e6, off=0.0)
    damping: float = quantity("N.s/m", "damping of each stop, one rope's share", 0.0, 1e7, default=0.0, nominal=1e4)
    up: float = quantity("m", "travel of the axle up to the upper stop, from where it is built", 0.0, 20.0, default=0.1)
    down: float = quantity("m", "travel of the axle down to the lower stop, from where it is built", 0.0, 20.0, default=0.1)


register(EndStops)
STIFFNESS = slot("effects.end_stops.stiffness")
DAMPING = slot("effects.end_stops.damping")
UP = slot("effects.end_stops.up")
DOWN = slot("effects.end_stops.down")


@kernel
def stop_law(p, depth, rate):
    """Force of a stop [N] and its derivatives by depth and by rate."""
    return unilateral_law(p[STIFFNESS], p[DAMPING], FADE, depth, rate)


@kernel
def push(n, t, p, q, v, w, f):
    """Add the forces of both stops on the sheave."""
    if p[STIFFNESS] == 0.0 and p[DAMPING] == 0.0:
        return 0.0
    upper = stop_law(p, p[PIT] - p[UP] - q[n], -v[n])[0]
    lower = stop_law(p, q[n] - p[PIT] - p[DOWN], v[n])[0]
    f[n] += upper - lower
    return (upper - lower) * v[n]


@kernel
def push_tangent(n, t, p, q, v, w, A, weights):
    """Stiffness and damping of the stop that the axle is in."""
    if p[STIFFNESS] == 0.0 and p[DAMPING] == 0.0:
        return
    _, by_depth, by_rate = stop_law(p, p[PIT] - p[UP] - q[n], -v[n])
    _, by_depth_below, by_rate_below = stop_law(p, q[n] - p[PIT] - p[DOWN], v[n])
    A[DXX * (n + 1) + n] += weights.ck * (by_depth + by_depth_below) + weights.cc * (by_rate + by_rate_below)


acts(EndStops, forces=push, tangents=push_tangent)
