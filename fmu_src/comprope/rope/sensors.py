"""What a displacement sensor at a fixed height in the shaft sees of the rope."""

from .jit import kernel


@kernel
def smooth(values, base, i, s):
    """Value at fraction s between nodes i and i + 1 of the cubic through four nodes (Catmull and Rom)."""
    a, b, c, d = values[base + i - 1], values[base + i], values[base + i + 1], values[base + i + 2]
    return b + 0.5 * s * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a)))


@kernel
def crossing(values, i, level):
    """Fraction between nodes i and i + 1 at which the cubic through four nodes meets a level."""
    low, high = 0.0, 1.0
    falling = values[i] > values[i + 1]
    for _ in range(40):
        middle = 0.5 * (low + high)
        if (smooth(values, 0, i, middle) < level) != falling:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@kernel
def sight(n, q, side, x, element):
    """Lateral position y [m] of the rope at depth x on a side (-1 car, 1 counterweight), and whether it is there.

    Seen from the rope's end on that side, the first crossing counts. Outside the rope's reach the
    position of the end, or of the lowest node, is given.
    """
    m, end = n + 1, 0 if side < 0 else n - 1
    if x < q[end]:
        return q[m + end], False
    i = end
    while 0 <= i - side < n and q[i - side] < x:
        i -= side
        if q[i - side] < q[i] and q[i] < x:
            return q[m + i], False
    low = i - 1 if side > 0 else i
    if low < 1 or low > n - 3:
        s = (x - q[low]) / (q[low + 1] - q[low])
        return q[m + low] + s * (q[m + low + 1] - q[m + low]), True
    return smooth(q, m, low, crossing(q, low, x)), True


@kernel
def side_maximum(n, q, side):
    """Largest outward position [m] on a side above the sheave's axle, and its depth x."""
    m, best, depth = n + 1, -1e300, 0.0
    for i in range(n):
        if q[i] <= q[n] and side * q[m + i] > best:
            best, depth = side * q[m + i], q[i]
    return best, depth
