"""Pieces of the file that `effect_skeleton` writes, by location of the force and by the coordinate that it follows."""

from string import Template

from .residual_correlation import COORDINATES

LOCATIONS = {  # by quantity of the location: the statements of a force, and its power
    "sheave_force": ("f[n] -= force", "-force * v[n]"),
    "sheave_torque": ("f[m + n] += force", "force * v[m + n]"),
    "car_side": ("power += on_side(n, p, q, v, f, force, -1.0)", "power"),
    "counterweight_side": ("power += on_side(n, p, q, v, f, force, 1.0)", "power"),
}
ENDS = {  # by quantity of the location: index of the coordinate and direction of a motion of an end
    "car_end_out": ("m", "-"), "counterweight_end_out": ("m + n - 1", ""),
    "car_end_up": ("0", "-"), "counterweight_end_up": ("n - 1", "-"),
}  # fmt: skip
SINUSOIDS = {  # by coordinate: quantity, unit, meaning, factor of the coordinate, and the coordinate with two derivatives by time
    COORDINATES["position"]: (
        "spacing", "m", "distance over which it repeats", "-2.0 * pi / p[SPACING]", ("q[0]", "v[0]", "a[0]"),
    ),
    "the sheave's angle": (
        "order", "1", "periods in a turn of the sheave", "p[ORDER]", ("q[2 * n + 1]", "v[2 * n + 1]", "a[2 * n + 1]"),
    ),
    "a frequency": ("frequency", "Hz", "frequency", "2.0 * pi * p[FREQUENCY]", ("t", "1.0", "0.0")),
}  # fmt: skip
PROPORTIONAL = {  # by coordinate: what the force is in proportion to
    COORDINATES["velocity"]: "-v[0]", COORDINATES["speed"]: "abs(v[0])", COORDINATES["sheave_velocity"]: "-v[n]",
}  # fmt: skip
FILE = Template('''"""$sentence

A skeleton: give it a name, and replace its law by the physics that you suppose.
"""

${imports}from comprope.effect import Effect, acts, kernel, quantity, register, slot


class MissingEffect(Effect):
    """Acts as $location, following $coordinate."""

    name = "missing_effect"
$quantities


register(MissingEffect)
$slots

$on_side
$kernel


acts(MissingEffect, $hook)
''')
ON_SIDE = '''
@kernel
def on_side(n, p, q, v, f, force, side):
    """Add an outward force per length to the nodes of a side within reach of the height, and return its power."""
    m, power = n + 1, 0.0
    for i in range(1, n - 1):
        share = 1.0 - abs(q[i] + p[HEIGHT]) / p[REACH]
        if share > 0.0 and q[i] < q[n] and side * q[m + i] > 0.0:
            length = 0.5 * (abs(q[i + 1] - q[i]) + abs(q[i] - q[i - 1]))
            f[m + i] += side * force * share * length
            power += side * force * share * length * v[m + i]
    return power

'''
