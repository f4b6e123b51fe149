"""Tangent of the contact: derivative of a quadrature point's force, and where it goes in the blocks of nodes and sheave."""

from ....kernels.jit import kernel
from ...runtime.array_layout import COLUMNS, CONTACT, ROWS


@kernel
def clear_contact_tangent(n, Z, first, last):
    """Empty the contact tangent of nodes first - 1 .. last + 1 and of the sheave."""
    m = n + 1
    for k in range(CONTACT):
        for i in range(first - 1, last + 2):
            Z[k * m + i] = 0.0
    for k in range(4):
        Z[CONTACT * m + k] = 0.0


@kernel
def point_tangent(weights, normal, velocity, rho, pressure, friction):
    """Derivative (xx, xy, yx, yy) of F = P (n - grip tau) by relative position (weight ck) and relative velocity (cc).

    A motion along n reduces the depth; one along tau turns n by 1 / rho. `pressure` is what `normal_law` gives, `friction`
    what `friction_law` gives.
    """
    ck, cc = weights
    nx, ny = normal
    vx, vy = velocity
    P, P_depth, P_rate = pressure
    grip, grip_slip = friction
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
def add_force_tangent(n, Z, i, shapes, a, centre, spin):
    """Subtract one point's tangent `a` from the node blocks, the sheave's columns and its height's row.

    The sheave's height moves the point's relative position by -1 in x and by -slope in y, its angle by -g (`centre` holds
    both), and its spin adds b (`spin`) through the slip.
    """
    na, nb, nc = shapes
    axx, axy, ayx, ayy = a
    gx, gy, slope = centre
    bx, by = spin
    m = n + 1
    cx, cy = bx - (axx * gx + axy * gy), by - (ayx * gx + ayy * gy)
    kx, ky = axx + slope * axy, ayx + slope * ayy
    for k, wk in ((0, na), (1, nb), (2, nc)):
        row = i - 1 + k
        for j, wj in ((0, na), (1, nb), (2, nc)):
            block, weight = 4 * (j - k + 2), wk * wj
            Z[block * m + row] -= weight * axx
            Z[(block + 1) * m + row] -= weight * axy
            Z[(block + 2) * m + row] -= weight * ayx
            Z[(block + 3) * m + row] -= weight * ayy
        Z[COLUMNS * m + row] += wk * kx
        Z[(COLUMNS + 1) * m + row] -= wk * cx
        Z[(COLUMNS + 2) * m + row] += wk * ky
        Z[(COLUMNS + 3) * m + row] -= wk * cy
        Z[ROWS * m + row] += wk * (axx + slope * ayx)
        Z[(ROWS + 1) * m + row] += wk * (axy + slope * ayy)
    Z[CONTACT * m] -= kx + slope * ky
    Z[CONTACT * m + 1] += cx + slope * cy


@kernel
def add_torque_tangent(n, Z, i, shapes, a, centre, spin, arm):
    """Subtract one point's tangent `a` from the row of the sheave's angle.

    The torque is -F . (lx, ly), and its arm turns with the relative position, which adds (hx, hy): `arm` holds both.
    """
    na, nb, nc = shapes
    axx, axy, ayx, ayy = a
    gx, gy, slope = centre
    bx, by = spin
    lx, ly, hx, hy = arm
    m = n + 1
    rx, ry = hy - (lx * axx + ly * ayx), -hx - (lx * axy + ly * ayy)
    for k, wk in ((0, na), (1, nb), (2, nc)):
        Z[(ROWS + 2) * m + i - 1 + k] -= wk * rx
        Z[(ROWS + 3) * m + i - 1 + k] -= wk * ry
    Z[CONTACT * m + 2] += rx + slope * ry
    Z[CONTACT * m + 3] += rx * gx + ry * gy + lx * bx + ly * by
