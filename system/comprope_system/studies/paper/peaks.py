"""Running distance at which a curve has its peak, and that of the residual vibration of a linear oscillator."""

import numpy as np

from ...presets.paper_installations import BUILDING, trip_up
from ...vibration.prescribed_trip import Floats


def peak(distances: Floats, values: Floats) -> float:
    """Distance [m] of the largest value, from the parabola through three samples; an end of the range if it is largest."""
    k = int(np.argmax(values))
    if k in (0, len(values) - 1):
        return float(distances[k])
    c = np.polyfit(distances[k - 1 : k + 2], values[k - 1 : k + 2], 2)
    return float(-0.5 * c[1] / c[0])


def oscillator_peak(period: float) -> float:
    """Running distance [m] for which the residual vibration of a linear oscillator of this period [s] is largest.

    The profile's spectrum is proportional to sin(w D / 4) sin(w (D / 2 - Tj) / 2), D its duration and Tj the jerk's,
    largest about D = period + Tj, not at D = period. Found on the exact profile.
    """
    distances = np.linspace(4.0, 80.0, 1500)
    residual = [_residual(distance, 2.0 * np.pi / period) for distance in distances]
    return float(distances[int(np.argmax(residual))])


def _residual(distance: float, w: float) -> float:
    trip = trip_up(BUILDING, distance)
    width = trip.ramp + trip.plateau
    braking = width + trip.ramp + trip.cruise  # begins so long after the start
    return float(abs(np.sin(0.5 * w * braking) * np.sin(0.5 * w * width) * np.sin(0.5 * w * trip.ramp)))
