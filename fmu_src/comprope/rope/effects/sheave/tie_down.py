"""Tie-down of the sheave: a damper that may act one way only, and whose valve closes above a speed.

Against a rise at speed v it holds with F = c_up v + c_lock s^2 / (s + BLEND), s = v - v_lock, the second part above v_lock only;
against a fall with c_down v. A hydraulic tie-down lets the sheave follow the rope's slow stretch and holds it when it jumps; a
one-way one lets it fall freely. An anti-rebound device has c_down too.
"""

from ....kernels.jit import kernel
from ....quantities import quantity
from ...parameters.parameter_vector import slot
from ...runtime.array_layout import DXX
from ..base import Effect, acts, register

BLEND = 0.01  # m/s over which the closing valve takes hold; regularisation


class TieDown(Effect):
    """Hydraulic or one-way tie-down of the sheave."""

    name = "tie_down"
    hypothesis = False
    upward_damping: float = quantity("N.s/m", "force per speed of a rise, one rope's share", 0.0, 1e7, default=0.0, nominal=1e3)
    downward_damping: float = quantity("N.s/m", "force per speed of a fall, one rope's share", 0.0, 1e7, default=0.0, nominal=1e3)
    locking_damping: float = quantity(
        "N.s/m", "force per speed above the locking speed of a rise, one rope's share", 0.0, 1e7, nominal=1e5, off=0.0
    )
    locking_speed: float = quantity("m/s", "speed of a rise at which the valve closes", 0.0, 10.0, default=0.3)


register(TieDown)
UPWARD = slot("effects.tie_down.upward_damping")
DOWNWARD = slot("effects.tie_down.downward_damping")
LOCKING = slot("effects.tie_down.locking_damping")
LOCKING_SPEED = slot("effects.tie_down.locking_speed")


@kernel
def holding_law(p, speed):
    """Force [N] that holds the sheave back at an upward speed, and its derivative."""
    if speed <= 0.0:
        return p[DOWNWARD] * speed, p[DOWNWARD]
    over = speed - p[LOCKING_SPEED]
    if over <= 0.0:
        return p[UPWARD] * speed, p[UPWARD]
    share = over / (over + BLEND)
    return p[UPWARD] * speed + p[LOCKING] * over * share, p[UPWARD] + p[LOCKING] * share * (2.0 - share)


@kernel
def hold(n, t, p, q, v, w, f):
    """Subtract the tie-down's force from those on the sheave."""
    force = holding_law(p, -v[n])[0]
    f[n] += force
    return force * v[n]


@kernel
def hold_tangent(n, t, p, q, v, w, A, weights):
    """Damping of the tie-down at the present speed."""
    A[DXX * (n + 1) + n] += weights.cc * holding_law(p, -v[n])[1]


acts(TieDown, forces=hold, tangents=hold_tangent)
