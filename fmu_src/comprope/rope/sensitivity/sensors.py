"""Directional derivative of what sensors read: `mechanics.sensors`, differentiated by hand."""

from ...kernels.jit import kernel
from ..mechanics.sensors import crossing, read_sensor
from ..parameters.parameter_vector import R
from ..runtime.kernel_arguments import Directions, Outputs, RopeData, State
from ..runtime.simd import LANES


@kernel
def sensed_node(n, q, side, x):
    """The lower node of the element that `read_sensor` reads at depth x on a side; -1 - i where it reads node i instead."""
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
def catmull_rom_slope(values, base, i, s):
    """Derivative of `catmull_rom` by s."""
    a, b, c, d = values[base + i - 1], values[base + i], values[base + i + 1], values[base + i + 2]
    return 0.5 * (c - a + s * (2.0 * (2.0 * a - 5.0 * b + 4.0 * c - d) + 3.0 * s * (3.0 * (b - c) + d - a)))


@kernel
def catmull_rom_weights(s):
    """Weights of the four nodes in `catmull_rom`."""
    return (
        0.5 * s * (-1.0 + s * (2.0 - s)),
        1.0 + 0.5 * s * s * (3.0 * s - 5.0),
        0.5 * s * (1.0 + s * (4.0 - 3.0 * s)),
        0.5 * s * s * (s - 1.0),
    )


@kernel
def read_sensors_along(rope: RopeData, state: State, outputs: Outputs, directions: Directions, sensors: int) -> None:
    """Set row j of the readings to that of sensor j: outward displacement, 1 if the rope is there, derivatives along directions.

    A sensor at a fixed depth reads dy - (dy/dx) dx of the place on the rope that is before it.
    """
    n, p, q, dq, number = rope.n, rope.p, state.q, directions.dq, directions.number
    readings, width = directions.work.readings, number + 2
    for j in range(sensors):
        side, x = 1 if outputs.sensors[2 * j + 1] != 0.0 else -1, -outputs.sensors[2 * j]
        read_sensor(n, q, side, x, outputs.reading)
        readings[j * width], readings[j * width + 1] = side * outputs.reading[0] - p[R], outputs.reading[1]
        i, lean, a, b, c, d = sensed_place(n, q, side, x)
        for k in range(number):
            at = (k // LANES * 2 * (n + 1) + 2 * i) * LANES + k % LANES
            moved = weighted_sum(dq, at + LANES, i, n, a, b, c, d) - lean * weighted_sum(dq, at, i, n, a, b, c, d)
            readings[j * width + 2 + k] = side * moved - directions.change[directions.parameters * k + R]


@kernel
def sensed_place(n, q, side, x):
    """A node i, the rope's inclination dy/dx at the place read, and the weights of nodes i - 1 .. i + 2 in the reading.

    Next to the ends elements are straight.
    """
    m, i = n + 1, sensed_node(n, q, side, x)
    if i < 0:
        return -1 - i, 0.0, 0.0, 1.0, 0.0, 0.0
    if i < 1 or i > n - 3:
        length = q[i + 1] - q[i]
        s = (x - q[i]) / length
        return i, (q[m + i + 1] - q[m + i]) / length, 0.0, 1.0 - s, s, 0.0
    s = crossing(q, i, x)
    a, b, c, d = catmull_rom_weights(s)
    return i, catmull_rom_slope(q, m, i, s) / catmull_rom_slope(q, 0, i, s), a, b, c, d


@kernel
def weighted_sum(dq, at, i, n, a, b, c, d):
    """Sum of the entries of nodes i - 1 .. i + 2 by their weights; nodes that do not exist have none."""
    total = b * dq[at]
    if i >= 1:
        total += a * dq[at - 2 * LANES]
    if i <= n - 2:
        total += c * dq[at + 2 * LANES]
    if i <= n - 3:
        total += d * dq[at + 4 * LANES]
    return total
