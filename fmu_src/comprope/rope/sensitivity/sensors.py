"""How the shape at rest and what sensors see answer the parameters: `statics` and `sensors`, differentiated."""

from ..mechanics.sensors import crossing, sight
from ..runtime.jit import kernel
from ..runtime.parameter_vector import R
from ..runtime.simd import LANES


@kernel
def seen_node(n, q, side, x):
    """The lower node of the element that `sensors.sight` sees at depth x on a side; -1 - i where it shows node i instead."""
    end = 0 if side < 0 else n - 1
    if x < q[end]:
        return -1 - end
    i = end
    while 0 <= i - side < n and q[i - side] < x:
        i -= side
        if q[i - side] < q[i] and q[i] < x:
            return -1 - i
    return i - 1 if side > 0 else i


@kernel
def smooth_slope(values, base, i, s):
    """Derivative of `sensors.smooth` by s."""
    a, b, c, d = values[base + i - 1], values[base + i], values[base + i + 1], values[base + i + 2]
    return 0.5 * (c - a + s * (2.0 * (2.0 * a - 5.0 * b + 4.0 * c - d) + 3.0 * s * (3.0 * (b - c) + d - a)))


@kernel
def weights(s):
    """What `sensors.smooth` makes of its four nodes, as weights."""
    return (
        0.5 * s * (-1.0 + s * (2.0 - s)),
        1.0 + 0.5 * s * s * (3.0 * s - 5.0),
        0.5 * s * (1.0 + s * (4.0 - 3.0 * s)),
        0.5 * s * s * (s - 1.0),
    )


@kernel
def look(n, directions, sensors, parameters, p, toward, q0, dq, sides, depths, seen, glances):
    """Set row j of glances to what sensor j sees: outward displacement, 1 if the rope is there, derivatives along all directions.

    A sensor at a fixed depth sees dy - (dy/dx) dx of the place on the rope that is before it.
    """
    width = directions + 2
    for j in range(sensors):
        side, x = int(sides[j]), depths[j]
        sight(n, q0, side, x, seen)
        glances[j * width], glances[j * width + 1] = side * seen[0] - p[R], seen[1]
        i, lean, a, b, c, d = seen_place(n, q0, side, x)
        for k in range(directions):
            at = (k // LANES * 2 * (n + 1) + 2 * i) * LANES + k % LANES
            moved = gather(dq, at + LANES, i, n, a, b, c, d) - lean * gather(dq, at, i, n, a, b, c, d)
            glances[j * width + 2 + k] = side * moved - toward[parameters * k + R]


@kernel
def seen_place(n, q, side, x):
    """A node i, the rope's inclination dy/dx where it is seen, and how nodes i - 1 .. i + 2 weigh in what is seen.

    Next to the ends elements are straight.
    """
    m, i = n + 1, seen_node(n, q, side, x)
    if i < 0:
        return -1 - i, 0.0, 0.0, 1.0, 0.0, 0.0
    if i < 1 or i > n - 3:
        length = q[i + 1] - q[i]
        s = (x - q[i]) / length
        return i, (q[m + i + 1] - q[m + i]) / length, 0.0, 1.0 - s, s, 0.0
    s = crossing(q, i, x)
    a, b, c, d = weights(s)
    return i, smooth_slope(q, m, i, s) / smooth_slope(q, 0, i, s), a, b, c, d


@kernel
def gather(dq, at, i, n, a, b, c, d):
    """Sum of the entries of nodes i - 1 .. i + 2 by their weights; nodes that do not exist have none."""
    total = b * dq[at]
    if i >= 1:
        total += a * dq[at - 2 * LANES]
    if i <= n - 2:
        total += c * dq[at + 2 * LANES]
    if i <= n - 3:
        total += d * dq[at + 4 * LANES]
    return total
