"""Contact and friction between rope and groove: P and F of eq. (1) and (2).

The contact acts along the rope, not at its nodes: piece i is the quadratic B-spline of nodes i-1, i,
i+1, which is smooth where pieces meet and stays within the band of the tangent. The laws of `contact_law`
hold at each of its quadrature points.

Friction acts on the sheave with the arm R of eq. (2), however far the rope sinks into the groove: a turn
winds 2 pi R of rope whatever the tension. The B-spline of nodes that wrap a circle lies l^2 / (8 R) inside
them; holding it at R_c = R - l^2 / (12 R) gives the polygon the pitch of R exactly (rope per radian), and the
rope leaves the sheave where a continuous one does, both to fourth order in l / R.
"""

from math import sqrt

from ....kernels.jit import kernel
from ...parameters.parameter_vector import ELEMENT, K, R
from ...runtime.array_layout import CONTACT_RESULTS, ELASTIC, FIRST, FORCE_X, FRICTION_LOSS, LAST, NORMAL_LOSS
from ..effect_hooks import all_groove, all_rail
from .contact_law import POINTS, contact_radius, friction_law, normal_law, shape
from .contact_tangent import add_force_tangent, add_torque_tangent, clear_contact_tangent, point_tangent


@kernel
def find_contact_range(n, p, q, ox, oy, contact):
    """Find the nodes near the groove: the piece of a node outside contact[FIRST..LAST] cannot touch it."""
    m, limit = n + 1, (p[R] + p[ELEMENT]) ** 2
    first, last = n, -1
    for i in range(2, n - 2):
        dx, dy = q[i] - ox, q[m + i] - oy
        if dx * dx + dy * dy < limit:
            if first == n:
                first = i
            last = i
    if last < 0:
        first = last = n // 2
    contact[FIRST] = max(first - 1, 2)
    contact[LAST] = min(last + 1, n - 3)


@kernel
def place_groove(p, depth, angle):
    """Offset (x, y) of the groove's centre from (depth, 0), its derivative by the sheave's angle, and that of y by depth."""
    x, y, gx, gy = all_groove(p, angle)
    aside, slope = all_rail(p, depth)
    return x, y + aside, gx, gy, slope


@kernel
def add_contact(n, p, motion, work, weights, tangent):
    """Add contact and friction to the forces on nodes and sheave; with `tangent` set work.Z to their tangent."""
    m, q, contact = n + 1, motion.q, work.contact
    groove = place_groove(p, q[n], q[m + n])
    find_contact_range(n, p, q, q[n] + groove[0], groove[1], contact)
    first, last = int(contact[FIRST]), int(contact[LAST])
    if tangent:
        clear_contact_tangent(n, work.Z, first, last)
    add_pieces(n, p, motion, groove, work, weights, tangent)


@kernel
def add_pieces(n, p, motion, groove, work, weights, tangent):
    """Add the contact of all pieces among the nodes near the groove that work.contact names."""
    m, q, contact = n + 1, motion.q, work.contact
    for k in range(CONTACT_RESULTS - 2):
        contact[k] = 0.0
    for i in range(int(contact[FIRST]), int(contact[LAST]) + 1):
        if near(m, p, q, i, q[n] + groove[0], groove[1]):
            add_piece(n, p, motion, i, groove, work, weights, tangent)


@kernel
def near(m, p, q, i, ox, oy):
    """Whether piece i may touch: the B-spline lies within the hull of its nodes' middles."""
    dx, dy = q[i] - ox, q[m + i] - oy
    limit = p[R] + 0.5 * p[ELEMENT]
    return dx * dx + dy * dy < limit * limit


@kernel
def add_piece(n, p, motion, i, groove, work, weights, tangent):
    """Add the contact forces of the piece of node i, summed over its quadrature points.

    dx, dy and vx, vy are position and velocity relative to the groove's centre; gx, gy is how that
    centre moves with the sheave's angle, slope how it moves aside with the sheave's depth.
    """
    q, v, contact = motion.q, motion.v, work.contact
    ex, ey, gx, gy, slope = groove
    ck, cc = weights
    m, radius, spin, length = n + 1, contact_radius(p), v[n + n + 1], p[ELEMENT] / POINTS
    fx, fy, vx0, vy0 = q[n] + ex, ey, v[n] + spin * gx, spin * gy + slope * v[n]
    ax, ay, bx, by, cx, cy, turn = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for g in range(POINTS):
        na, nb, nc = shape(g)
        dx, dy = na * q[i - 1] + nb * q[i] + nc * q[i + 1] - fx, na * q[m + i - 1] + nb * q[m + i] + nc * q[m + i + 1] - fy
        square = dx * dx + dy * dy
        if square < radius * radius:
            vx, vy = na * v[i - 1] + nb * v[i] + nc * v[i + 1] - vx0, na * v[m + i - 1] + nb * v[m + i] + nc * v[m + i + 1] - vy0
            rho = sqrt(square)
            nx, ny = dx / rho, dy / rho
            depth, rate, slip = radius - rho, -(nx * vx + ny * vy), nx * vy - ny * vx + spin * radius
            P, P_depth, P_rate = normal_law(p, depth, rate)
            grip, grip_slip = friction_law(p, slip)
            hx, hy = length * P * (nx + grip * ny), length * P * (ny - grip * nx)
            ax, ay, bx, by, cx, cy = ax + na * hx, ay + na * hy, bx + nb * hx, by + nb * hy, cx + nc * hx, cy + nc * hy
            lx, ly = gx + radius * ny, gy - radius * nx
            turn += hx * lx + hy * ly
            contact[ELASTIC] += 0.5 * length * p[K] * depth * depth
            contact[NORMAL_LOSS] += length * (P - p[K] * depth) * rate
            contact[FRICTION_LOSS] += length * P * grip * slip
            if tangent:
                axx, axy, ayx, ayy = point_tangent(weights, (nx, ny), (vx, vy), rho, (P, P_depth, P_rate), (grip, grip_slip))
                a = length * axx, length * axy, length * ayx, length * ayy
                drive, stiff = -cc * length * P * grip_slip * radius, ck * length * P * radius / rho
                shapes, centre, slipping = (na, nb, nc), (gx, gy, slope), (-drive * ny, drive * nx)
                add_force_tangent(n, work.Z, i, shapes, a, centre, slipping)
                add_torque_tangent(n, work.Z, i, shapes, a, centre, slipping, (lx, ly, stiff * nx, stiff * ny))
    add_to_nodes(n, work, i, (ax, ay), (bx, by), (cx, cy), turn, slope)


@kernel
def add_to_nodes(n, work, i, a, b, c, turn, slope):
    """Add a piece's forces on its three nodes, and their reaction on the sheave: eq. (2)."""
    m, f = n + 1, work.f
    f[i - 1] += a[0]
    f[m + i - 1] += a[1]
    f[i] += b[0]
    f[m + i] += b[1]
    f[i + 1] += c[0]
    f[m + i + 1] += c[1]
    f[n] -= a[0] + b[0] + c[0] + slope * (a[1] + b[1] + c[1])
    f[m + n] -= turn
    work.contact[FORCE_X] -= a[0] + b[0] + c[0]
