"""Reading of a displacement sensor at a fixed height in the shaft."""

from ...kernels.jit import kernel


@kernel
def catmull_rom(values, base, i, s):
    """Value at fraction s between nodes i and i + 1 of the smooth cubic between them (Catmull and Rom): exact for parabolas."""
    a, b, c, d = values[base + i - 1], values[base + i], values[base + i + 1], values[base + i + 2]
    return b + 0.5 * s * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a)))


@kernel
def crossing(values, i, level):
    """Fraction between nodes i and i + 1 at which the cubic through four nodes meets a level."""
    low, high = 0.0, 1.0
    falling = values[i] > values[i + 1]
    for _ in range(40):
        middle = 0.5 * (low + high)
        if (catmull_rom(values, 0, i, middle) < level) != falling:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@kernel
def read_sensor(n, q, side, x, reading):
    """Lateral position of the rope at depth x on a side (-1 car, 1 counterweight); sets reading = (y [m], 1 if it is there).

    Seen from the rope's end on that side, the first crossing counts. Outside the rope's reach the
    position of the end, or of the lowest node, is given.
    """
    m, end = n + 1, 0 if side < 0 else n - 1
    reading[0], reading[1] = q[m + end], 0.0
    if x < q[end]:
        return
    i = end
    while 0 <= i - side < n and q[i - side] < x:
        i -= side
        if q[i - side] < q[i] and q[i] < x:
            reading[0] = q[m + i]
            return
    low = i - 1 if side > 0 else i
    reading[1] = 1.0
    if low < 1 or low > n - 3:
        s = (x - q[low]) / (q[low + 1] - q[low])
        reading[0] = q[m + low] + s * (q[m + low + 1] - q[m + low])
    else:
        reading[0] = catmull_rom(q, m, low, crossing(q, low, x))


@kernel
def find_side_maximum(n, q, side, reading):
    """Largest outward position on a side above the sheave's axle; sets reading = (that [m], its depth x [m])."""
    m, best, depth = n + 1, -1e300, 0.0
    for i in range(n):
        if q[i] <= q[n] and side * q[m + i] > best:
            best, depth = side * q[m + i], q[i]
    reading[0], reading[1] = best, depth
