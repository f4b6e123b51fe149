"""Input shapers: a trip is the sum of delayed fractions of itself, so that the vibration of a known period cancels.

With K = exp(-z pi / sqrt(1 - z^2)) for the damping ratio z, and T the damped period, the weights (to be divided by their sum)
and their delays are

    1  nothing                   1                           0
    2  ZV (Posicast)             1, K                        0, T/2
    3  ZVD, EI with a tolerance  1 + V, 2 (1 - V) K, (1 + V) K^2    0, T/2, T

ZV leaves no residual vibration at its period; ZVD (V = 0) none, and hardly any nearby; EI leaves the fraction V of that of a
single impulse at its period, and at most V over a wider band (exact without damping; Singhose, Seering, Singer 1994). The
weights are positive and sum to one: shaping exceeds no limit of speed, acceleration or jerk.
"""

from ...kernels.kernel_linking import uncompiled
from ..kernels.arguments import DELAYS, TRIP, WEIGHTS
from ..kernels.reference import shaped_trip
from ..parameters import Shaper

Impulses = tuple[tuple[float, float], ...]  # delays [s] and weights
NO_SHAPING: Impulses = ((0.0, 1.0),)
_KERNELS = uncompiled(shaped_trip)


def impulses(shaper: Shaper, stops: tuple[float, float], height: float) -> Impulses:
    """Delays [s] and weights of the shaper for a trip between two heights [m] in a shaft of `height` [m]."""
    trip, count = [0.0] * TRIP, int(shaper.impulses)
    _KERNELS.set_impulses(trip, shaper.impulses, shaper.damping, shaper.tolerance, design_period(shaper, stops, height))
    return tuple(zip(trip[DELAYS : DELAYS + count], trip[WEIGHTS : WEIGHTS + count], strict=True))


def design_period(shaper: Shaper, stops: tuple[float, float], height: float) -> float:
    """The undamped design period [s] for a trip: linear in the distance of its midpoint from the middle of the shaft.

    The longest period is that of the longer side, hence symmetric about the middle.
    """
    return float(_KERNELS.period_of_trip(*stops, height, shaper.period_landing, shaper.period_middle))
