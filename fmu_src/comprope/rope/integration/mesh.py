"""The mesh: number and natural length of the elements, corrected for the chords at the sheave."""

from math import ceil, pi, sqrt

from ...kernels.jit import kernel
from ..parameters.parameter_vector import EI, ELEMENT, HEIGHT, PIT, G, J, K, M, R, slot
from ..runtime.kernel_arguments import RopeData, Workspace
from ..runtime.status import NOT_WHOLE, SUCCESS, TOO_COARSE

LENGTH = slot("rope.element_length")
MASS, INERTIA, ROPES = slot("sheave.mass"), slot("sheave.inertia"), slot("sheave.ropes")
FEWEST_ELEMENTS = 16


@kernel
def rope_length(p):
    """Natural length of the rope [m]."""
    return 2.0 * p[PIT] + p[HEIGHT] + pi * p[R]


@kernel
def chord_shortening(p, l):
    """By how much chords of length l are shorter than the rope where it bends on to the sheave and off it [m].

    To second order in l the energy of the polygon differs from that of the rope by -T l^2 (2 L + A) / (48 R^2), where
    T = M g / 2, L = (EI / T)^(1/2) is the length in which the free rope straightens, and A = (4 EI / k)^(1/4) that in
    which it sinks into the groove. Its derivative by the sheave's weight 2 T is how much too low the sheave would hang,
    l^2 (L + A) / (96 R^2): half of this length. From L = 2^(1/2) R on the rope hangs as a loop wider than the sheave, whose
    length chords have right.
    """
    straightens, sinks = sqrt(2.0 * p[EI] / (p[M] * p[G])), sqrt(sqrt(4.0 * p[EI] / p[K]))
    if straightens > sqrt(2.0) * p[R]:
        return 0.0
    return l * l * (straightens + sinks) / (48.0 * p[R] * p[R])


@kernel
def element_length(p, elements):
    """Natural length of each element [m], so many on the whole rope."""
    length = rope_length(p)
    return (length - chord_shortening(p, length / elements)) / elements


@kernel
def share_sheave(p):
    """Set the mass and inertia that one rope carries."""
    p[M] = p[MASS] / p[ROPES]
    p[J] = p[INERTIA] / p[ROPES]


@kernel
def generate_mesh(rope: RopeData) -> float:
    """Set what is derived: one rope's share of the sheave, and the length of whole elements; returns the number of nodes."""
    p = rope.p
    share_sheave(p)
    elements = max(round(rope_length(p) / p[LENGTH]), FEWEST_ELEMENTS)
    p[ELEMENT] = element_length(p, elements)
    return elements + 1.0


@kernel
def check_mesh(rope: RopeData, work: Workspace) -> int:
    """Refuse parts of ropes, and elements too long to lie round the sheave; returns SUCCESS or the kind of refusal."""
    p, message = rope.p, work.message
    if p[ROPES] != ceil(p[ROPES]):
        message[0] = p[ROPES]
        return NOT_WHOLE
    message[0], message[1] = p[LENGTH], p[R]
    return TOO_COARSE if p[LENGTH] > 0.5 * p[R] else SUCCESS
