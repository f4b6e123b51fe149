"""Laws of contact and friction at one point of rope and groove, and where on the rope those points lie.

With penetration p of the groove's circle and its rate,

    P = max(0, k p + c p / (p + fade) dp/dt)  per length, outward,
    F = -mu P v_s / sqrt(v_s^2 + v_0^2)       along the groove, v_s = v_t - R theta' the slip velocity.

The damping fades in with penetration, so that it does not switch on at first touch.
"""

from math import sqrt

from ....kernels.jit import kernel
from ...parameters.parameter_vector import ELEMENT, MU, V0, C, K, R

FADE = 1e-4  # m, penetration over which contact damping fades in
POINTS = 8  # quadrature points of a piece; with 4, what rests on the groove depends on where the nodes sit


@kernel
def contact_radius(p):
    """Radius at which the B-spline of the nodes is held [m]."""
    return p[R] - p[ELEMENT] * p[ELEMENT] / (12.0 * p[R])


@kernel
def shape(g):
    """Values of the three quadratic B-splines at quadrature point g of a piece.

    The points are equally spaced and weigh the same, as suits a load that moves through them.
    """
    xi = (g + 0.5) / POINTS - 0.5
    return 0.5 * (0.5 - xi) * (0.5 - xi), 0.75 - xi * xi, 0.5 * (0.5 + xi) * (0.5 + xi)


@kernel
def unilateral_law(k, c, fade, depth, rate):
    """max(0, k d + c d / (d + fade) dd/dt) of a contact that pushes only, and its derivatives by depth and by rate.

    Zero out of contact; the damping fades in over the depth `fade`.
    """
    if depth <= 0.0:
        return 0.0, 0.0, 0.0
    fading = c * depth / (depth + fade)
    force = k * depth + fading * rate
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, k + c * fade / ((depth + fade) * (depth + fade)) * rate, fading


@kernel
def normal_law(p, depth, rate):
    """Normal force per length P [N/m] of the groove, and its derivatives by depth and by rate."""
    return unilateral_law(p[K], p[C], FADE, depth, rate)


@kernel
def friction_law(p, slip):
    """Regularised Coulomb friction: mu s / sqrt(s^2 + v_0^2) and its derivative by slip velocity."""
    root = 1.0 / sqrt(slip * slip + p[V0] * p[V0])
    return p[MU] * slip * root, p[MU] * p[V0] * p[V0] * root * root * root
