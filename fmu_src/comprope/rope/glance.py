"""How the shape at rest and what sensors see answer the parameters: `statics` and `sensors`, differentiated."""

from .dynamics import forces
from .ends import place_ends
from .hooks import all_begin
from .jit import kernel
from .sensors import crossing
from .slots import ELEMENT
from .statics import rest
from .vector import LANES


@kernel
def hang_again(n, t, p1, smooth1, path1, q, v, a, w, f, touch, hi, hd, power, A, L, B, Z, r):
    """Move q to rest with other parameters and ends than it was at; sets the history hi of a rope at rest there.

    `smooth1` are the parameters p1 without friction and without effects that have a history. Returns the number of
    iterations, or -1 where no shape at rest is found.
    """
    place_ends(n, t, p1, path1, 1.0, 0.0, q, v, a)
    for i in range(2 * (n + 1)):
        v[i] = 0.0
    count = rest(n, smooth1, q, v, w, f, touch, hi, hd, power, A, L, B, Z, r, p1[ELEMENT])
    forces(n, t, smooth1, q, v, w, f, touch, hi, hd, power, Z, 0.0, 0.0, False)
    all_begin(n, p1, w, hi)
    return count


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
def look(n, directions, sensors, q0, dq, sides, depths, glances):
    """Set glances[j directions + k] to the derivative along direction k of the outward position that sensor j sees.

    A sensor at a fixed depth sees dy - (dy/dx) dx of the place on the rope that is before it. Next to the ends the
    rope is seen as straight elements.
    """
    m = n + 1
    for j in range(sensors):
        x = depths[j]
        i = seen_node(n, q0, int(sides[j]), x)
        if 1 <= i <= n - 3:
            s = crossing(q0, i, x)
            lean = smooth_slope(q0, m, i, s) / smooth_slope(q0, 0, i, s)
            a, b, c, d = weights(s)
        elif i >= 0:
            s = (x - q0[i]) / (q0[i + 1] - q0[i])
            lean = (q0[m + i + 1] - q0[m + i]) / (q0[i + 1] - q0[i])
            a, b, c, d = 0.0, 1.0 - s, s, 0.0
        else:
            i, lean, a, b, c, d = -1 - i, 0.0, 0.0, 1.0, 0.0, 0.0
        for k in range(directions):
            at = (k // LANES * 2 * m + 2 * i) * LANES + k % LANES
            dx = gather(dq, at, i, n, a, b, c, d)
            glances[j * directions + k] = sides[j] * (gather(dq, at + LANES, i, n, a, b, c, d) - lean * dx)


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
