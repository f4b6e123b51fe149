"""Probe of the input estimation, in the form of a user's effect: a pulse of force or motion at a location and a time.

The pulse is a cubic B-spline B((t - time) / width) of support 4 width; such pulses a width apart sum to one. A lateral force
from the shaft acts on a side of the rope with a triangular distribution over height, and only above the sheave's axle.
"""

from math import copysign

from comprope.effect import Effect, acts, kernel, quantity, register, slot

MOST = 1e9


class ResidualForce(Effect):
    """Force or motion that is missing from the model, as a pulse."""

    name = "residual_force"
    sheave_force: float = quantity("N", "upward force on the sheave", -MOST, MOST, default=0.0, nominal=1.0)
    sheave_torque: float = quantity(
        "N.m", "torque on the sheave, as it turns while the car goes up", -MOST, MOST, default=0.0, nominal=1.0
    )
    car_side: float = quantity("N/m", "outward force on the car's side of the rope", -MOST, MOST, default=0.0, nominal=1.0)
    counterweight_side: float = quantity("N/m", "the same on the counterweight's side", -MOST, MOST, default=0.0, nominal=1.0)
    car_end_out: float = quantity("m", "outward motion of the end under the car", -MOST, MOST, default=0.0, nominal=1.0)
    counterweight_end_out: float = quantity("m", "the same under the counterweight", -MOST, MOST, default=0.0, nominal=1.0)
    car_end_up: float = quantity("m", "upward motion of the end under the car", -MOST, MOST, default=0.0, nominal=1.0)
    counterweight_end_up: float = quantity("m", "the same under the counterweight", -MOST, MOST, default=0.0, nominal=1.0)
    height: float = quantity("m", "height at which a lateral force is largest", -MOST, MOST, default=0.0, nominal=20.0)
    reach: float = quantity("m", "distance above and below at which it is zero", 0.01, MOST, default=1.0, nominal=20.0)
    time: float = quantity("s", "time of the pulse's maximum", -MOST, MOST, default=0.0, nominal=0.0)
    width: float = quantity("s", "a quarter of the pulse's length", 1e-3, MOST, default=1.0, nominal=1.0)


register(ResidualForce)
FORCE = slot("effects.residual_force.sheave_force")
TORQUE = slot("effects.residual_force.sheave_torque")
CAR = slot("effects.residual_force.car_side")
COUNTERWEIGHT = slot("effects.residual_force.counterweight_side")
CAR_OUT = slot("effects.residual_force.car_end_out")
COUNTERWEIGHT_OUT = slot("effects.residual_force.counterweight_end_out")
CAR_UP = slot("effects.residual_force.car_end_up")
COUNTERWEIGHT_UP = slot("effects.residual_force.counterweight_end_up")
HEIGHT = slot("effects.residual_force.height")
REACH = slot("effects.residual_force.reach")
TIME = slot("effects.residual_force.time")
WIDTH = slot("effects.residual_force.width")


@kernel
def pulse(p, t):
    """B((t - time) / width) and its first two derivatives by time."""
    x = (t - p[TIME]) / p[WIDTH]
    u, back, rate = abs(x), copysign(1.0, x), 1.0 / p[WIDTH]
    if u >= 2.0:
        return 0.0, 0.0, 0.0
    if u >= 1.0:
        d = 2.0 - u
        return d * d * d / 6.0, -0.5 * d * d * back * rate, d * rate * rate
    return 2.0 / 3.0 - u * u + 0.5 * u * u * u, (1.5 * u - 2.0) * u * back * rate, (3.0 * u - 2.0) * rate * rate


@kernel
def add_forces(n, t, p, q, v, w, f):
    """Add the pulse's forces on sheave and rope, and return their power; a node carries half of each adjacent element."""
    m, size, power = n + 1, pulse(p, t)[0], 0.0
    if size == 0.0:
        return 0.0
    f[n] -= size * p[FORCE]
    f[m + n] += size * p[TORQUE]
    power += size * (p[TORQUE] * v[m + n] - p[FORCE] * v[n])
    if p[CAR] == 0.0 and p[COUNTERWEIGHT] == 0.0:
        return power
    for i in range(1, n - 1):
        share = 1.0 - abs(q[i] + p[HEIGHT]) / p[REACH]
        if share > 0.0 and q[i] < q[n]:
            length = 0.5 * (abs(q[i + 1] - q[i]) + abs(q[i] - q[i - 1]))
            force = size * share * length * (-p[CAR] if q[m + i] < 0.0 else p[COUNTERWEIGHT])
            f[m + i] += force
            power += force * v[m + i]
    return power


@kernel
def no_tangents(n, t, p, q, v, w, A, weights):
    """No tangents: derivatives by the pulse are taken at zero size, where its own derivatives by the state vanish."""


@kernel
def move_ends(n, t, p, q, v, a):
    """Add the pulse's motion to both ends."""
    m = n + 1
    y, rate, bow = pulse(p, t)
    if y == 0.0:
        return
    for k, by in ((0, -p[CAR_UP]), (n - 1, -p[COUNTERWEIGHT_UP]), (m, -p[CAR_OUT]), (m + n - 1, p[COUNTERWEIGHT_OUT])):
        q[k] += by * y
        v[k] += by * rate
        a[k] += by * bow


acts(ResidualForce, forces=add_forces, tangents=no_tangents, ends=move_ends)
