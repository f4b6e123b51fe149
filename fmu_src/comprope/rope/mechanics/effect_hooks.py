"""Where effects act: the functions that the kernels call, here those of a model without effects.

`compiler` replaces them by functions of the same names that run through the effects of a model.
"""

from ...kernels.jit import kernel


@kernel
def all_moments(n, p, w, h0, h1, power):
    """Add to the bending moments w[MOMENT] and to their derivative w[STIFF]."""


@kernel
def all_forces(n, t, p, q, v, w, f, power):
    """Add to the forces f."""


@kernel
def all_tangents(n, t, p, q, v, w, A, weights):
    """Subtract ck df/dq + cc df/dv of those forces from A, where ck, cc = weights."""


@kernel
def all_ends(n, t, p, q, v, a):
    """Move the rope's ends."""


@kernel
def all_begin(n, p, w, h0):
    """Set the history h0 of a rope at rest."""


@kernel
def all_groove(p, angle):
    """Offset (x, y) of the groove's centre from the axle, and its derivative by angle."""
    return 0.0, 0.0, 0.0, 0.0


@kernel
def all_rail(p, depth):
    """Offset y of the axle from the middle between the sheave's sides at a depth, and its derivative by depth."""
    return 0.0, 0.0
