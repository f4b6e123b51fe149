"""Directional derivative of contact and friction between rope and groove: `mechanics.sheave_contact`, differentiated by hand.

All of a block's directions go through the contact's quadrature points together. With r and u a point's position and
velocity relative to the groove's centre, rho = |r|, n = r / rho, and forces h = P (n + grip tau) on the rope,

    drho = n . dr,  dn = (dr - n drho) / rho,
    ddepth = dR_c - drho,  drate = -(dn . u + n . du),  dslip = dn x u + n x du + dspin R_c + spin dR_c.

How the groove's centre itself answers is read off `place_groove` by differences, whatever effects move it.
"""

from math import sqrt

from ...kernels.jit import kernel
from ..mechanics.contact.contact_law import FADE, POINTS, contact_radius, friction_law, normal_law, shape
from ..mechanics.contact.sheave_contact import near, place_groove
from ..parameters.parameter_vector import ELEMENT, MU, V0, C, K, R
from ..runtime.array_layout import FIRST, LAST
from ..runtime.simd import LANES, load, store
from .internal_forces import predicted


@kernel
def centre_derivative(e, parameters, place, moves, lane, centre):
    """Set lane `lane` of `centre` to the derivatives of what `place_groove` gives, by a difference e.

    `parameters` are those before and after, `place` is depth and angle of the sheave, `moves` how they change.
    """
    ex, ey, gx, gy, slope = place_groove(parameters[0], place[0], place[1])
    ex1, ey1, gx1, gy1, slope1 = place_groove(parameters[1], place[0] + e * moves[0], place[1] + e * moves[1])
    centre[lane], centre[LANES + lane] = (ex1 - ex) / e, (ey1 - ey) / e
    centre[2 * LANES + lane], centre[3 * LANES + lane] = (gx1 - gx) / e, (gy1 - gy) / e
    centre[4 * LANES + lane] = (slope1 - slope) / e


@kernel
def law_derivative(p, dp, d, at, change):
    """Changes of the normal force per length and of the friction's share of it, by those of depth, rate and slip."""
    depth, rate, slip = at
    ddepth, drate, dslip = change
    _, P_depth, P_rate = normal_law(p, depth, rate)
    _, grip_slip = friction_law(p, slip)
    faded, root = depth / (depth + FADE) * rate, 1.0 / sqrt(slip * slip + p[V0] * p[V0])
    dP = P_depth * ddepth + P_rate * drate + depth * load(dp, d + K * LANES) + faded * load(dp, d + C * LANES)
    dgrip = grip_slip * dslip + (slip * root) * load(dp, d + MU * LANES)
    return dP, dgrip - (p[MU] * slip * p[V0] * root * root * root) * load(dp, d + V0 * LANES)


@kernel
def point_derivative(p, dp, d, point, change, a, b):
    """Changes of a quadrature point's force on the rope and of its torque on the sheave, by those of r (a) and u (b).

    `point` has the contact radius, the sheave's spin, r, u and how the groove's centre moves with the sheave's angle;
    `change` the changes of the radius, of the element's length (relative), of the spin and of that motion of the centre.
    """
    radius, spin, dx, dy, vx, vy, gx, gy = point
    dradius, grown, dspin, dgx, dgy = change
    ax, ay = a
    bx, by = b
    rho = sqrt(dx * dx + dy * dy)
    nx, ny, per_rho = dx / rho, dy / rho, 1.0 / rho
    depth, rate, slip = radius - rho, -(nx * vx + ny * vy), nx * vy - ny * vx + spin * radius
    P, grip = normal_law(p, depth, rate)[0], friction_law(p, slip)[0]
    away, across = nx * ax + ny * ay, nx * ay - ny * ax
    mx, my = (-ny * per_rho) * across, (nx * per_rho) * across
    drate = 0.0 * away - vx * mx - vy * my - nx * bx - ny * by
    dslip = vy * mx - vx * my + nx * by - ny * bx + radius * dspin + spin * dradius
    dP, dgrip = law_derivative(p, dp, d, (depth, rate, slip), (dradius - away, drate, dslip))
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
def lateral_force(p, point):
    """Lateral force [N] on the rope at a quadrature point (see `point_derivative`)."""
    radius, spin, dx, dy, vx, vy, _, _ = point
    rho = sqrt(dx * dx + dy * dy)
    nx, ny = dx / rho, dy / rho
    P = normal_law(p, radius - rho, -(nx * vx + ny * vy))[0]
    return p[ELEMENT] / POINTS * P * (ny - friction_law(p, nx * vy - ny * vx + spin * radius)[0] * nx)


@kernel
def contact_derivative(n, p, state, contact, directions, block, combination):
    """Add to a block of D `new` times how contact and friction answer, predicted h ahead; set its part of `lift`.

    work.centre has the changes of the groove's centre, see `centre_derivative`; `lift` is the vertical force on the sheave.
    """
    h, new, _ = combination
    q, v, dp, dq, dv, da = state.q, state.v, directions.dp, directions.dq, directions.dv, directions.da
    D, centre = directions.work.D, directions.work.centre
    d, base = directions.parameters * LANES * block, 2 * (n + 1) * LANES * block
    m, radius, spin, l = n + 1, contact_radius(p), v[n + n + 1], p[ELEMENT]
    ex, ey, gx, gy, slope = place_groove(p, q[n], q[m + n])
    fx, fy, vx0, vy0 = q[n] + ex, ey, v[n] + spin * gx, spin * gy + slope * v[n]
    grown, sheave = (1.0 / l) * load(dp, d + ELEMENT * LANES), base + 2 * LANES * n
    dradius = (1.0 + l * l / (12.0 * p[R] * p[R])) * load(dp, d + R * LANES) - (l * l / (6.0 * p[R])) * grown
    dx0, dvx0 = predicted(sheave, h, 0.5 * h * h, dq, dv, da)
    _, dspin = predicted(sheave + LANES, h, 0.5 * h * h, dq, dv, da)
    dgx, dgy, dslope = load(centre, 2 * LANES), load(centre, 3 * LANES), load(centre, 4 * LANES)
    dx0, dy0 = dx0 + load(centre, 0), load(centre, LANES)
    dvy0 = gy * dspin + spin * dgy + slope * dvx0 + v[n] * dslope
    dvx0 = dvx0 + gx * dspin + spin * dgx
    total, aside, torque, change = 0.0 * dx0, 0.0 * dx0, 0.0 * dx0, (dradius, grown, dspin, dgx, dgy)
    side, tilts = 0.0, False
    for lane in range(LANES):
        tilts = tilts or centre[4 * LANES + lane] != 0.0
    for i in range(int(contact[FIRST]), int(contact[LAST]) + 1):
        if near(m, p, q, i, fx, fy):
            for g in range(POINTS):
                na, nb, nc = shape(g)
                dx = na * q[i - 1] + nb * q[i] + nc * q[i + 1] - fx
                dy = na * q[m + i - 1] + nb * q[m + i] + nc * q[m + i + 1] - fy
                vx = na * v[i - 1] + nb * v[i] + nc * v[i + 1] - vx0
                vy = na * v[m + i - 1] + nb * v[m + i] + nc * v[m + i + 1] - vy0
                if pressed(p, radius, dx, dy, vx, vy):
                    x, bx = interpolated(base + 2 * LANES * i, na, nb, nc, h, dq, dv, da)
                    y, by = interpolated(base + 2 * LANES * i + LANES, na, nb, nc, h, dq, dv, da)
                    point = (radius, spin, dx, dy, vx, vy, gx, gy)
                    hx, hy, twist = point_derivative(p, dp, d, point, change, (x - dx0, y - dy0), (bx - dvx0, by - dvy0))
                    distribute(D, base + 2 * LANES * i, na, nb, nc, new * hx, new * hy)
                    total, aside, torque = total + hx, aside + hy, torque + twist
                    side += lateral_force(p, point) if tilts else 0.0
    store(D, sheave, load(D, sheave) - new * (total + slope * aside + side * dslope))
    store(D, sheave + LANES, load(D, sheave + LANES) - new * torque)
    store(directions.work.lift, block * LANES, 0.0 * total - total)


@kernel
def interpolated(entry, na, nb, nc, h, dq, dv, da):
    """Predicted changes of position and velocity between three nodes, by their weights, from the middle one's entry."""
    half = 0.5 * h * h
    xa, va = predicted(entry - 2 * LANES, h, half, dq, dv, da)
    xb, vb = predicted(entry, h, half, dq, dv, da)
    xc, vc = predicted(entry + 2 * LANES, h, half, dq, dv, da)
    return na * xa + nb * xb + nc * xc, na * va + nb * vb + nc * vc


@kernel
def distribute(D, entry, na, nb, nc, hx, hy):
    """Add a point's force to its three nodes, from the middle one's entry."""
    store(D, entry - 2 * LANES, load(D, entry - 2 * LANES) + na * hx)
    store(D, entry - LANES, load(D, entry - LANES) + na * hy)
    store(D, entry, load(D, entry) + nb * hx)
    store(D, entry + LANES, load(D, entry + LANES) + nb * hy)
    store(D, entry + 2 * LANES, load(D, entry + 2 * LANES) + nc * hx)
    store(D, entry + 3 * LANES, load(D, entry + 3 * LANES) + nc * hy)
