"""Natural periods of a hanging string whose tension increases with height: closed-form solutions for comparison.

A string of mass per length rho hangs with tension T0 at its lower end and T0 + rho g L at its upper end,
both ends fixed laterally, without bending stiffness. With s = T / (rho g), the height above the point where
the tension would vanish, its lateral shape of angular frequency w is a Bessel function of 2 w sqrt(s / g).
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import j0, y0

from comprope.rope.parameters import Base


@dataclass(frozen=True)
class HangingString:
    """Tension at the lower end [N], mass per length [kg/m], length [m], gravity [m/s2]."""

    tension: float
    mass_per_length: float
    length: float
    gravity: float = 9.81

    @property
    def travel_time(self) -> float:
        """Time [s] a wave takes from end to end: the integral of ds / sqrt(T / rho)."""
        lower, upper = self._arguments
        return upper - lower

    @property
    def _arguments(self) -> tuple[float, float]:
        """2 sqrt(s / g) at both ends [s]."""
        s = self.tension / (self.mass_per_length * self.gravity)
        return 2.0 * sqrt(s / self.gravity), 2.0 * sqrt((s + self.length) / self.gravity)

    def height_at(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """Height above the lower end [m] that a wave reaches in a share (0 to 1) of the travel time."""
        lower, upper = self._arguments
        return 0.25 * self.gravity * ((lower + share * (upper - lower)) ** 2 - lower**2)

    def share_at(self, height: NDArray[np.float64]) -> NDArray[np.float64]:
        """The share of the travel time (0 to 1) after which a wave from the lower end is at a height above it [m]."""
        lower, upper = self._arguments
        return (np.sqrt(lower**2 + 4.0 * height / self.gravity) - lower) / (upper - lower)

    def wkb_period(self, half_waves: int = 1) -> float:
        """Natural period [s] of a mode by the travel time: 2 t / n; (4/g)(sqrt(c0^2 + g L) - c0) for n = 1."""
        return 2.0 * self.travel_time / half_waves

    def period(self, half_waves: int = 1) -> float:
        """Natural period [s] of a mode, exact for a string: J0(w a) Y0(w b) = J0(w b) Y0(w a)."""
        a, b = self._arguments

        def mismatch(w: float) -> float:
            return float(j0(w * a) * y0(w * b) - j0(w * b) * y0(w * a))

        low, high = ((half_waves + shift) * pi / self.travel_time for shift in (-0.4, 0.4))
        return 2.0 * pi / float(brentq(mismatch, low, high, xtol=1e-14, rtol=1e-13))


def side_string(model: Base, car: float, side: str = "counterweight") -> HangingString:
    """The string equivalent to one side of the rope, car at `car` [m]: from the height of the axle to the end of the rope.

    The axle carries its own weight and that of the rope wrapped round it. A rope with bending
    stiffness rolls on the groove, so that its side rotates about the axle: the string is fixed at this height.
    """
    shaft, rope, sheave = model.shaft, model.rope, model.sheave
    end = car if side == "car" else shaft.height - car
    wrapped = rope.mass_per_length * pi * sheave.radius
    tension = 0.5 * shaft.gravity * (sheave.mass_per_rope + wrapped)
    return HangingString(tension, rope.mass_per_length, end + shaft.pit, shaft.gravity)


def mass_for_period(model: Base, car: float, period: float) -> float:
    """Sheave mass of one rope [kg] at which the counterweight's side has this first natural period [s], by the travel time.

    From (4/g)(sqrt(c0^2 + g L) - c0) = period with c0^2 = T0 / rho and T0 half the weight on the axle.
    """
    string, g = side_string(model, car), model.shaft.gravity
    quarter = 0.25 * g * period
    speed = (g * string.length - quarter**2) / (2.0 * quarter)
    wrapped = np.pi * model.sheave.radius * string.mass_per_length
    return float(2.0 * string.mass_per_length * speed**2 / g - wrapped)
