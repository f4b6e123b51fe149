"""Directional derivative of contact and friction between rope and groove: `contact`, differentiated by hand.

All of a block's directions go through the contact's quadrature points together. With r and u a point's position and
velocity relative to the groove's centre, rho = |r|, n = r / rho, and forces h = P (n + grip tau) on the rope,

    drho = n . dr,  dn = (dr - n drho) / rho,
    ddepth = dR_c - drho,  drate = -(dn . u + n . du),  dslip = dn x u + n x du + dspin R_c + spin dR_c.

How the groove's centre itself answers is read off `all_groove` by differences, whatever effects move it.
"""

from math import sqrt

from ..mechanics.effect_hooks import all_groove
from ..mechanics.sheave_contact import FADE, POINTS, contact_radius, friction_law, near, normal_law, shape
from ..runtime.array_layout import FIRST, LAST
from ..runtime.jit import kernel
from ..runtime.parameter_vector import ELEMENT, MU, V0, C, K, R
from ..runtime.simd import LANES, put, take
from .internal_forces import ahead


@kernel
def centre_slope(m, e, p, p1, angle, turned, lane, centre):
    """Set lane `lane` of `centre` to the derivatives of the groove's offset and of its derivative by angle, by a difference e."""
    ex, ey, gx, gy = all_groove(p, angle)
    ex1, ey1, gx1, gy1 = all_groove(p1, angle + e * turned)
    centre[lane], centre[LANES + lane] = (ex1 - ex) / e, (ey1 - ey) / e
    centre[2 * LANES + lane], centre[3 * LANES + lane] = (gx1 - gx) / e, (gy1 - gy) / e


@kernel
def law_slope(p, dp, d, depth, rate, slip, ddepth, drate, dslip):
    """Changes of the normal force per length and of the friction's share of it."""
    _, P_depth, P_rate = normal_law(p, depth, rate)
    _, grip_slip = friction_law(p, slip)
    faded, root = depth / (depth + FADE) * rate, 1.0 / sqrt(slip * slip + p[V0] * p[V0])
    dP = P_depth * ddepth + P_rate * drate + depth * take(dp, d + K * LANES) + faded * take(dp, d + C * LANES)
    dgrip = grip_slip * dslip + (slip * root) * take(dp, d + MU * LANES)
    return dP, dgrip - (p[MU] * slip * p[V0] * root * root * root) * take(dp, d + V0 * LANES)


@kernel
def point_slope(p, dp, d, radius, spin, dx, dy, vx, vy, gx, gy, dradius, grown, dspin, dgx, dgy, ax, ay, bx, by):
    """Changes of a quadrature point's force on the rope and of its torque on the sheave, by those of r (a) and u (b)."""
    rho = sqrt(dx * dx + dy * dy)
    nx, ny, per_rho = dx / rho, dy / rho, 1.0 / rho
    depth, rate, slip = radius - rho, -(nx * vx + ny * vy), nx * vy - ny * vx + spin * radius
    P, grip = normal_law(p, depth, rate)[0], friction_law(p, slip)[0]
    away, across = nx * ax + ny * ay, nx * ay - ny * ax
    mx, my = (-ny * per_rho) * across, (nx * per_rho) * across
    drate = 0.0 * away - vx * mx - vy * my - nx * bx - ny * by
    dslip = vy * mx - vx * my + nx * by - ny * bx + radius * dspin + spin * dradius
    dP, dgrip = law_slope(p, dp, d, depth, rate, slip, dradius - away, drate, dslip)
    length = p[ELEMENT] / POINTS
    sx, sy = nx + grip * ny, ny - grip * nx
    dP = length * (dP + P * grown)
    hx = sx * dP + (length * P) * (mx + grip * my + ny * dgrip)
    hy = sy * dP + (length * P) * (my - grip * mx - nx * dgrip)
    armx, army = dgx + radius * my + ny * dradius, dgy - radius * mx - nx * dradius
    twist = (gx + radius * ny) * hx + (gy - radius * nx) * hy + (length * P * sx) * armx + (length * P * sy) * army
    return hx, hy, twist


@kernel
def pressed(p, radius, dx, dy, vx, vy):
    """Whether the groove presses on the rope at a point."""
    square = dx * dx + dy * dy
    if square >= radius * radius:
        return False
    rho = sqrt(square)
    return normal_law(p, radius - rho, -(dx * vx + dy * vy) / rho)[0] > 0.0


@kernel
def groove_slope(n, p, q, v, dp, d, base, h, new, centre, dq, dv, da, touch, D, lift, to):
    """Add to a block of D `new` times how contact and friction answer, h ahead; set the block of lift at `to`.

    `centre` has the changes of the groove's centre, see `centre_slope`; lift is the vertical force on the sheave.
    """
    m, radius, spin, l = n + 1, contact_radius(p), v[n + n + 1], p[ELEMENT]
    ex, ey, gx, gy = all_groove(p, q[m + n])
    fx, fy, vx0, vy0 = q[n] + ex, ey, v[n] + spin * gx, spin * gy
    grown, sheave = (1.0 / l) * take(dp, d + ELEMENT * LANES), base + 2 * LANES * n
    dradius = (1.0 + l * l / (12.0 * p[R] * p[R])) * take(dp, d + R * LANES) - (l * l / (6.0 * p[R])) * grown
    dx0, dvx0 = ahead(sheave, h, 0.5 * h * h, dq, dv, da)
    _, dspin = ahead(sheave + LANES, h, 0.5 * h * h, dq, dv, da)
    dgx, dgy = take(centre, 2 * LANES), take(centre, 3 * LANES)
    dx0, dy0 = dx0 + take(centre, 0), take(centre, LANES)
    dvx0, dvy0 = dvx0 + gx * dspin + spin * dgx, gy * dspin + spin * dgy
    total, torque = 0.0 * dx0, 0.0 * dx0
    for i in range(int(touch[FIRST]), int(touch[LAST]) + 1):
        if near(m, p, q, i, fx, fy):
            for g in range(POINTS):
                na, nb, nc = shape(g)
                dx = na * q[i - 1] + nb * q[i] + nc * q[i + 1] - fx
                dy = na * q[m + i - 1] + nb * q[m + i] + nc * q[m + i + 1] - fy
                vx = na * v[i - 1] + nb * v[i] + nc * v[i + 1] - vx0
                vy = na * v[m + i - 1] + nb * v[m + i] + nc * v[m + i + 1] - vy0
                if pressed(p, radius, dx, dy, vx, vy):
                    x, bx = between(base + 2 * LANES * i, na, nb, nc, h, dq, dv, da)
                    y, by = between(base + 2 * LANES * i + LANES, na, nb, nc, h, dq, dv, da)
                    hx, hy, twist = point_slope(p, dp, d, radius, spin, dx, dy, vx, vy, gx, gy, dradius, grown, dspin, dgx, dgy,
                                                x - dx0, y - dy0, bx - dvx0, by - dvy0)  # fmt: skip
                    share_out(D, base + 2 * LANES * i, na, nb, nc, new * hx, new * hy)
                    total, torque = total + hx, torque + twist
    put(D, sheave, take(D, sheave) - new * total)
    put(D, sheave + LANES, take(D, sheave + LANES) - new * torque)
    put(lift, to, 0.0 * total - total)


@kernel
def between(at, na, nb, nc, h, dq, dv, da):
    """Predicted changes of position and velocity between three nodes, by their weights; `at` is the middle one's entry."""
    half = 0.5 * h * h
    xa, va = ahead(at - 2 * LANES, h, half, dq, dv, da)
    xb, vb = ahead(at, h, half, dq, dv, da)
    xc, vc = ahead(at + 2 * LANES, h, half, dq, dv, da)
    return na * xa + nb * xb + nc * xc, na * va + nb * vb + nc * vc


@kernel
def share_out(D, at, na, nb, nc, hx, hy):
    """Add a point's force to its three nodes; `at` is the middle one's entry."""
    put(D, at - 2 * LANES, take(D, at - 2 * LANES) + na * hx)
    put(D, at - LANES, take(D, at - LANES) + na * hy)
    put(D, at, take(D, at) + nb * hx)
    put(D, at + LANES, take(D, at + LANES) + nb * hy)
    put(D, at + 2 * LANES, take(D, at + 2 * LANES) + nc * hx)
    put(D, at + 3 * LANES, take(D, at + 3 * LANES) + nc * hy)
