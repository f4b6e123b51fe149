"""Contact and friction between rope and groove: P and F of eq. (1) and (2).

The contact acts along the rope, not at its nodes: piece i is the quadratic B-spline of nodes i-1, i,
i+1, which is smooth where pieces meet and stays within the band of the tangent. At each quadrature
point, with penetration p of the groove's circle and its rate,

    P = max(0, k p + c p / (p + fade) dp/dt)  per length, outward,
    F = -mu P v_s / sqrt(v_s^2 + v_0^2)       along the groove, v_s = v_t - R theta' the slip velocity.

Friction acts on the sheave with the arm R of eq. (2), however far the rope sinks into the groove: a turn
winds 2 pi R of rope whatever the tension. The damping fades in with penetration, so that it does not
switch on at first touch. The B-spline of nodes that wrap a circle lies l^2 / (8 R) inside them; holding it
at R_c = R - l^2 / (12 R) gives the polygon the pitch of R exactly (rope per radian), and the rope leaves
the sheave where a continuous one does, both to fourth order in l / R.
"""

from math import sqrt

from ..runtime.array_layout import COLUMNS, CONTACT, ELASTIC, FIRST, FORCE_X, FRICTION_LOSS, LAST, NORMAL_LOSS, ROWS, TOUCH
from ..runtime.jit import kernel
from ..runtime.parameter_vector import ELEMENT, MU, V0, C, K, R
from .effect_hooks import all_groove

FADE = 1e-4  # m, penetration over which contact damping fades in
POINTS = 8  # quadrature points of a piece; with 4, what rests on the groove depends on where the nodes sit


@kernel
def contact_radius(p):
    """Radius at which the B-spline of the nodes is held [m]."""
    return p[R] - p[ELEMENT] * p[ELEMENT] / (12.0 * p[R])


@kernel
def reach(n, p, q, ox, oy, touch):
    """Find the nodes near the groove: the piece of a node outside touch[FIRST..LAST] cannot touch it."""
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
    touch[FIRST] = max(first - 1, 2)
    touch[LAST] = min(last + 1, n - 3)


@kernel
def shape(g):
    """Values of the three quadratic B-splines at quadrature point g of a piece.

    The points are equally spaced and weigh the same, as suits a load that moves through them.
    """
    xi = (g + 0.5) / POINTS - 0.5
    return 0.5 * (0.5 - xi) * (0.5 - xi), 0.75 - xi * xi, 0.5 * (0.5 + xi) * (0.5 + xi)


@kernel
def normal_law(p, depth, rate):
    """Normal force per length P [N/m], its derivatives by depth and by rate; zero out of contact."""
    if depth <= 0.0:
        return 0.0, 0.0, 0.0
    fading = p[C] * depth / (depth + FADE)
    force = p[K] * depth + fading * rate
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, p[K] + p[C] * FADE / ((depth + FADE) * (depth + FADE)) * rate, fading


@kernel
def friction_law(p, slip):
    """Regularised Coulomb friction: mu s / sqrt(s^2 + v_0^2) and its derivative by slip velocity."""
    root = 1.0 / sqrt(slip * slip + p[V0] * p[V0])
    return p[MU] * slip * root, p[MU] * p[V0] * p[V0] * root * root * root


@kernel
def add_contact(n, p, q, v, f, touch, Z, ck, cc, tangent):
    """Add contact and friction to the forces on nodes and sheave; with `tangent` set Z to their tangent."""
    m = n + 1
    ex, ey, gx, gy = all_groove(p, q[m + n])
    reach(n, p, q, q[n] + ex, ey, touch)
    for k in range(TOUCH - 2):
        touch[k] = 0.0
    first, last = int(touch[FIRST]), int(touch[LAST])
    if tangent:
        clear(n, Z, first, last)
    for i in range(first, last + 1):
        if near(m, p, q, i, q[n] + ex, ey):
            touch_piece(n, p, q, v, f, touch, i, ex, ey, gx, gy, Z, ck, cc, tangent)


@kernel
def near(m, p, q, i, ox, oy):
    """Whether piece i may touch: the B-spline lies within the hull of its nodes' middles."""
    dx, dy = q[i] - ox, q[m + i] - oy
    limit = p[R] + 0.5 * p[ELEMENT]
    return dx * dx + dy * dy < limit * limit


@kernel
def clear(n, Z, first, last):
    """Empty the contact tangent of nodes first - 1 .. last + 1 and of the sheave."""
    m = n + 1
    for k in range(CONTACT):
        for i in range(first - 1, last + 2):
            Z[k * m + i] = 0.0
    for k in range(4):
        Z[CONTACT * m + k] = 0.0


@kernel
def touch_piece(n, p, q, v, f, touch, i, ex, ey, gx, gy, Z, ck, cc, tangent):
    """Add the contact forces of the piece of node i, summed over its quadrature points.

    dx, dy and vx, vy are position and velocity relative to the groove's centre; gx, gy is how that
    centre moves with the sheave's angle.
    """
    m, radius, spin, length = n + 1, contact_radius(p), v[n + n + 1], p[ELEMENT] / POINTS
    fx, fy, vx0, vy0 = q[n] + ex, ey, v[n] + spin * gx, spin * gy
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
            touch[ELASTIC] += 0.5 * length * p[K] * depth * depth
            touch[NORMAL_LOSS] += length * (P - p[K] * depth) * rate
            touch[FRICTION_LOSS] += length * P * grip * slip
            if tangent:
                axx, axy, ayx, ayy = linearise(ck, cc, nx, ny, vx, vy, rho, P, P_depth, P_rate, grip, grip_slip)
                axx, axy, ayx, ayy = length * axx, length * axy, length * ayx, length * ayy
                drive, stiff = -cc * length * P * grip_slip * radius, ck * length * P * radius / rho
                scatter(n, i, na, nb, nc, Z, axx, axy, ayx, ayy, gx, gy, -drive * ny, drive * nx)
                turn_rows(
                    n, i, na, nb, nc, Z, axx, axy, ayx, ayy, gx, gy, -drive * ny, drive * nx, lx, ly, stiff * nx, stiff * ny
                )
    add_to_nodes(n, f, touch, i, ax, ay, bx, by, cx, cy, turn)


@kernel
def add_to_nodes(n, f, touch, i, ax, ay, bx, by, cx, cy, turn):
    """Add a piece's forces on its three nodes, and their reaction on the sheave: eq. (2)."""
    m = n + 1
    f[i - 1] += ax
    f[m + i - 1] += ay
    f[i] += bx
    f[m + i] += by
    f[i + 1] += cx
    f[m + i + 1] += cy
    f[n] -= ax + bx + cx
    f[m + n] -= turn
    touch[FORCE_X] -= ax + bx + cx


@kernel
def linearise(ck, cc, nx, ny, vx, vy, rho, P, P_depth, P_rate, grip, grip_slip):
    """Derivative of F = P (n - grip tau) by relative position (weight ck) and relative velocity (cc).

    A motion along n reduces the depth; one along tau turns n by 1 / rho.
    """
    tx, ty = -ny, nx
    vn, vt = nx * vx + ny * vy, tx * vx + ty * vy
    P_n, P_t = -ck * P_depth - cc * P_rate, -ck * P_rate * vt / rho
    s_t = cc - ck * vn / rho
    nn, nt = P_n, P_t + ck * P * grip / rho
    tn, tt = -P_n * grip, ck * P / rho - P_t * grip - P * grip_slip * s_t
    return (
        nx * (nn * nx + nt * tx) + tx * (tn * nx + tt * tx),
        nx * (nn * ny + nt * ty) + tx * (tn * ny + tt * ty),
        ny * (nn * nx + nt * tx) + ty * (tn * nx + tt * tx),
        ny * (nn * ny + nt * ty) + ty * (tn * ny + tt * ty),
    )


@kernel
def scatter(n, i, na, nb, nc, Z, axx, axy, ayx, ayy, gx, gy, bx, by):
    """Subtract one point's tangent from the node blocks, the sheave's columns and its height's row.

    The sheave's height moves the point's relative position by -1 in x, its angle by -g, and its spin
    adds b through the slip.
    """
    m = n + 1
    cx, cy = bx - (axx * gx + axy * gy), by - (ayx * gx + ayy * gy)
    for k, wk in ((0, na), (1, nb), (2, nc)):
        row = i - 1 + k
        for j, wj in ((0, na), (1, nb), (2, nc)):
            block, weight = 4 * (j - k + 2), wk * wj
            Z[block * m + row] -= weight * axx
            Z[(block + 1) * m + row] -= weight * axy
            Z[(block + 2) * m + row] -= weight * ayx
            Z[(block + 3) * m + row] -= weight * ayy
        Z[COLUMNS * m + row] += wk * axx
        Z[(COLUMNS + 1) * m + row] -= wk * cx
        Z[(COLUMNS + 2) * m + row] += wk * ayx
        Z[(COLUMNS + 3) * m + row] -= wk * cy
        Z[ROWS * m + row] += wk * axx
        Z[(ROWS + 1) * m + row] += wk * axy
    Z[CONTACT * m] -= axx
    Z[CONTACT * m + 1] += cx


@kernel
def turn_rows(n, i, na, nb, nc, Z, axx, axy, ayx, ayy, gx, gy, bx, by, lx, ly, hx, hy):
    """Subtract one point's tangent from the row of the sheave's angle.

    The torque is -F . (lx, ly), and its arm turns with the relative position.
    """
    m = n + 1
    rx, ry = hy - (lx * axx + ly * ayx), -hx - (lx * axy + ly * ayy)
    for k, wk in ((0, na), (1, nb), (2, nc)):
        Z[(ROWS + 2) * m + i - 1 + k] -= wk * rx
        Z[(ROWS + 3) * m + i - 1 + k] -= wk * ry
    Z[CONTACT * m + 2] += rx
    Z[CONTACT * m + 3] += rx * gx + ry * gy + lx * bx + ly * by
