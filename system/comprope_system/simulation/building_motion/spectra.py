"""Spectral densities of ground acceleration and of wind, up to a factor; frequencies in Hz."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

GROUND_DAMPING = 0.6  # of the soil's resonance, after Kanai and Tajimi
FILTER_DAMPING = 0.6  # of the filter that takes slow motion out, after Clough and Penzien
FILTER_PERIODS = 4.0  # how much slower than the soil that filter is; it keeps the displacement of the ground finite
GUST_LENGTH = 1200.0  # m, of Davenport's spectrum


def ground_acceleration(frequency: Floats, soil_period: float) -> Floats:
    """Kanai's and Tajimi's spectrum of soil with a period [s], less slow motion.

    S = (1 + (2 z r)^2) / ((1 - r^2)^2 + (2 z r)^2) * s^4 / ((1 - s^2)^2 + (2 z s)^2), r = f / f_soil, s = f / f_filter.
    Source: R. Clough, J. Penzien, *Dynamics of Structures*, 1975.
    """
    r, s = frequency * soil_period, frequency * soil_period * FILTER_PERIODS
    soil, slow = (2.0 * GROUND_DAMPING * r) ** 2, (2.0 * FILTER_DAMPING * s) ** 2
    return np.asarray((1.0 + soil) / ((1.0 - r**2) ** 2 + soil) * s**4 / ((1.0 - s**2) ** 2 + slow))


def wind_force(frequency: Floats, speed: float, area: float) -> Floats:
    """Spectrum of the force of gusts on a building: Davenport's of the wind, times Vickery's aerodynamic admittance.

    S = x^2 / (f (1 + x^2)^(4/3)) / (1 + (2 f sqrt(A) / V)^(4/3))^2, x = 1200 m f / V, with the mean speed V [m/s] at 10 m and the
    area A [m2] that the wind meets. A. Davenport, *Quarterly Journal of the Royal Meteorological Society* 87, 1961; B. Vickery,
    *Wind Effects on Buildings and Structures*, NPL, 1965.
    """
    x = GUST_LENGTH * frequency / speed
    admittance = 1.0 / (1.0 + (2.0 * frequency * np.sqrt(area) / speed) ** (4.0 / 3.0)) ** 2
    return np.asarray(x**2 / (frequency * (1.0 + x**2) ** (4.0 / 3.0)) * admittance)
