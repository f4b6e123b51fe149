"""A rope that is pushed: the axial force of a segment as a function of that of a rod.

A rod of the rope's stiffness and damping would carry X = EA (L/l - 1) + c_A rate. The rope carries T = X where X >= 0. Where
X < 0 the slope dT/dX falls smoothly from 1 to r, `rope.compression_ratio`, as X goes to -X_s:

    X_s = EA SLACK_STRAIN,  z = -X / X_s,
    T = -X_s (r z + (1 - r) (z - z^3 + z^4 / 2))   for z < 1,   T = -X_s (r z + (1 - r) / 2)   beyond.

A wire rope cannot push: it buckles. Lumped-mass models of mooring lines let it carry no compression at all (M. Hall, A. Goupee,
*Ocean Engineering* 104, 2015); the small ratio that is left here keeps the equations solvable. The law is monotone in strain and
in strain rate, so the difference between T and its part without damping always dissipates.
"""

from ...kernels.jit import kernel
from ..parameters.parameter_vector import CA, EA, ELEMENT, RATIO
from ..runtime.array_layout import INVERSE, SHARE, TENSION, TX, TY

# Strain over which the rope loses its stiffness. With EA = rho c^2 and c near 2.6 km/s, the speed of axial waves in steel ropes,
# the compression that remains is rho c^2 SLACK_STRAIN / 2, the weight of 3.4 m of rope, whatever its size. At a fifth of it
# Newton's iteration takes half as many steps again.
SLACK_STRAIN = 1e-5


@kernel
def axial_force(p, x):
    """Force [N] of a segment in which a rod would carry x [N], and its derivative by x."""
    if x >= 0.0 or p[RATIO] == 1.0:
        return x, 1.0
    most = p[EA] * SLACK_STRAIN
    r, z = p[RATIO], -x / most
    if z >= 1.0:
        return -most * (r * z + 0.5 * (1.0 - r)), r
    rest = 1.0 - z
    return -most * (r * z + (1.0 - r) * z * (1.0 - z * z * (1.0 - 0.5 * z))), r + (1.0 - r) * rest * rest * (1.0 + 2.0 * z)


@kernel
def force_by_ratio(p, x):
    """Derivative of the force by the compression ratio [N]."""
    most = p[EA] * SLACK_STRAIN
    z = -x / most
    return -most * (z - 0.5) if z >= 1.0 else -most * z * z * z * (1.0 - 0.5 * z)


@kernel
def elastic_energy(p, x):
    """Energy per length [J/m] of a segment whose elastic force would be x [N] in a rod."""
    if x >= 0.0:
        return 0.5 * x * x / p[EA]
    most = p[EA] * SLACK_STRAIN
    r, z = p[RATIO], -x / most
    soft = 0.5 * z - 0.15 if z >= 1.0 else z * z * (0.5 - z * z * (0.25 - 0.1 * z))
    return most * SLACK_STRAIN * (0.5 * r * z * z + (1.0 - r) * soft)


@kernel
def relieve_compression(n, p, w):
    """Give each segment the force of a rope in place of a rod's, and set its share of the rod's stiffness."""
    m = n + 1
    for e in range(n - 1):
        w[TENSION * m + e], w[SHARE * m + e] = axial_force(p, w[TENSION * m + e])


@kernel
def slack_balance(n, p, v, w):
    """What the energy [J] and the axial damping's power [W] of shortened or pushed segments have beyond a rod's."""
    m, l, energy, power = n + 1, p[ELEMENT], 0.0, 0.0
    if p[RATIO] == 1.0:
        return energy, power
    for e in range(n - 1):
        stretch = 1.0 / w[INVERSE * m + e] - l
        if stretch < 0.0 or w[SHARE * m + e] != 1.0:
            rate = w[TX * m + e] * (v[e + 1] - v[e]) + w[TY * m + e] * (v[m + e + 1] - v[m + e])
            x = p[EA] * stretch / l
            energy += l * elastic_energy(p, x) - 0.5 * x * stretch
            power += (w[TENSION * m + e] - axial_force(p, x)[0] - p[CA] * rate / l) * rate
    return energy, power
