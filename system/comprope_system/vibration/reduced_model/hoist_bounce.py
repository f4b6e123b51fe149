"""Vertical vibration of car and counterweight on their hoist ropes while the traction sheave follows the reference.

Each is an oscillator with the period and damping of the closed loop of servo and hoist at the present car position:

    d'' + 2 z w d' + w^2 d = -a_ref     d: displacement of the end relative to the rim's reference, up for the car

w and z are those of the loop's pole nearest to sqrt(EA / (L m)) of the end's own rope. The rope is
excited by the acceleration; its reaction on the car is neglected.
"""

from dataclasses import dataclass
from functools import lru_cache

import control
import numba
import numpy as np
from numpy.typing import NDArray

from comprope.drive.control.hoist_dynamics import lumped_hoist
from comprope.drive.control.stability_margins import open_loop
from comprope.drive.parameters import Drive

from .sampled_motion import SampledMotion

Floats = NDArray[np.float64]

CAR_POSITIONS = 13  # car positions at which the loop is looked at


@dataclass(frozen=True)
class HoistBounce:
    """Frequencies [rad/s] and damping ratios of car and counterweight (2, PLACES) with the car at `heights` (PLACES,) [m]."""

    heights: Floats
    frequency: Floats
    damping: Floats

    def period(self, car: float) -> float:
        """The longer of both periods [s] for a car height [m]."""
        return float(2.0 * np.pi / min(np.interp(car, self.heights, one) for one in self.frequency))

    def ends(self, motion: SampledMotion) -> tuple[Floats, Floats]:
        """Vibration of car and counterweight about the reference: displacement, speed, acceleration (3, n), up positive."""
        added = []
        for k, sign in enumerate((1.0, -1.0)):
            w = np.interp(motion.position, self.heights, self.frequency[k])
            z = np.interp(motion.position, self.heights, self.damping[k])
            added.append(_integrate_bounce(motion.dt, sign * motion.acceleration, w, z))
        return added[0], added[1]


def hoist_bounce(drive: Drive) -> HoistBounce:
    """Oscillators of car and counterweight for a drive; cached, since independent of the trip."""
    return _hoist(drive.without_trips)


@lru_cache(maxsize=8)
def _hoist(drive: Drive) -> HoistBounce:
    heights = np.linspace(0.0, drive.shaft.height, CAR_POSITIONS)
    found = np.array([_bounces(drive, float(height)) for height in heights])
    return HoistBounce(heights, found[:, 0].T, found[:, 1].T)


def _bounces(drive: Drive, height: float) -> Floats:
    """Frequencies and damping ratios (2, 2) of car and counterweight with the car at a height."""
    parts, stiffness = lumped_hoist(drive, height), drive.plant.rope_stiffness
    own = np.sqrt(stiffness / np.array([
        parts.car_rope * parts.car, parts.counterweight_rope * parts.counterweight
    ]))  # fmt: skip
    poles = np.log(control.feedback(open_loop(drive, height), 1).poles().astype(complex)) / drive.servo.sample_period
    swinging = poles[(poles.imag > 0.0) & (np.abs(poles.imag) > np.abs(poles.real))]
    if not len(swinging):
        return np.array([own, np.full(2, 0.5)])
    nearest = [swinging[int(np.argmin(np.abs(np.log(np.abs(swinging) / w))))] for w in own]
    return np.array([np.abs(nearest), -np.real(nearest) / np.abs(nearest)])


@numba.njit(cache=True)
def _integrate_bounce(dt, a, w, z):  # type: ignore[no-untyped-def]
    """Response d, d' and d'' (3, n) by the implicit midpoint rule."""
    found, h = np.zeros((3, len(a))), 0.5 * dt
    d = u = 0.0
    for i in range(len(a) - 1):
        ww, zz, push = 0.5 * (w[i] + w[i + 1]), 0.5 * (z[i] + z[i + 1]), 0.5 * (a[i] + a[i + 1])
        middle = (u - h * (push + ww * ww * d)) / (1.0 + 2.0 * h * zz * ww + h * h * ww * ww)
        d, u = d + dt * middle, 2.0 * middle - u
        found[0, i + 1], found[1, i + 1] = d, u
    for i in range(len(a)):
        found[2, i] = -a[i] - 2.0 * z[i] * w[i] * found[1, i] - w[i] * w[i] * found[0, i]
    return found
