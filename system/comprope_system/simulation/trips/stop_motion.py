"""Motion of car and counterweight when a trip ends with a given deceleration.

The mass that moves down is stopped: its deceleration builds up over RISE, stays, and falls back. The other one mirrors it as long
as the hoist ropes can hold it back, which is up to gravity's acceleration. Beyond, its ropes go slack: it flies on, decelerated
by gravity alone, falls back and lands on its taut ropes over LANDING, without a rebound. The hoist ropes do not stretch
otherwise, and the compensation ropes do not act on the motion.
"""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from scipy.interpolate import PPoly
from scipy.optimize import brentq

from comprope.drive.trajectory.s_curve import TrajectoryPoint
from comprope.errors import InputError

from .stop import SLOWEST, Stop

RISE = 0.04  # s in which a brake or a safety gear takes hold; engineering judgement: tens of milliseconds
LANDING = 0.045  # s: a quarter period of a mass on hoist ropes at 5 Hz
LONGEST_APPROACH, APPROACH_STEP = 1000.0, 0.05  # s until a landing is passed, and how exactly that is found

Pieces = tuple[list[float], list[float]]  # times [s], and accelerations [m/s2] that are linear between them


class Trajectory(Protocol):
    """What the car does without the stop."""

    def at(self, time: float) -> TrajectoryPoint:
        """State of the reference at a time [s]."""


class StoppedMotion:
    """Height [m], velocity and acceleration of one end: a trajectory, and from a time on pieces of linear acceleration."""

    def __init__(self, before: Trajectory, shaft: float | None, times: Sequence[float], accelerations: Sequence[float]) -> None:
        """`shaft` is its height [m] for the counterweight, which mirrors the trajectory, and None for the car."""
        self._before, self._shaft, self.begin, self.end = before, shaft, times[0], times[-1]
        start, knots, values = self._trip(times[0]), np.array(times), np.array(accelerations)
        self._acceleration = PPoly(np.array([np.diff(values) / np.diff(knots), values[:-1]]), knots)
        self._velocity = _integral(self._acceleration, start.velocity)
        self._position = _integral(self._velocity, start.position)

    def _trip(self, time: float) -> TrajectoryPoint:
        at = self._before.at(time)
        if self._shaft is None:
            return at
        return TrajectoryPoint(self._shaft - at.position, -at.velocity, -at.acceleration, -at.jerk)

    def position(self, time: float) -> float:
        """Height [m]."""
        return self._trip(time).position if time < self.begin else float(self._position(min(time, self.end)))

    def velocity(self, time: float) -> float:
        """Velocity [m/s], up positive."""
        if time < self.begin:
            return self._trip(time).velocity
        return float(self._velocity(time)) if time < self.end else 0.0

    def acceleration(self, time: float) -> float:
        """Acceleration [m/s2], up positive."""
        if time < self.begin:
            return self._trip(time).acceleration
        return float(self._acceleration(time)) if time < self.end else 0.0


def _integral(rate: PPoly, start: float) -> PPoly:
    """The integral of a piecewise polynomial that begins with `start`."""
    found = rate.antiderivative()
    found.c[-1] += start
    return found


def moving_at(trip: Trajectory, stop: Stop) -> TrajectoryPoint:
    """What the car does when it is stopped; raises `InputError` where there is nothing to stop, or for a safety gear upward."""
    at = trip.at(stop.time)
    if abs(at.velocity) < SLOWEST:
        raise InputError(f"stop = {stop.time:g} s: the car is at rest at {at.position:g} m; a time at which it moves is accepted")
    if stop.safety_gear and at.velocity > 0.0:
        raise InputError(f"safety_gear: the car moves up at {stop.time:g} s; a time at which it moves down is accepted")
    return at


def buffer_contact(trip: Trajectory, height: float) -> float:
    """When a car that runs on is at a landing [s]; raises `InputError` if it does not get there."""
    times = np.arange(0.0, LONGEST_APPROACH, APPROACH_STEP)
    beyond = next((float(time) for time in times if not 0.0 < trip.at(time).position < height and trip.at(time).velocity), None)
    if beyond is None:
        raise InputError(f"buffer: the car does not run past a landing within {LONGEST_APPROACH:g} s")
    return beyond


def stopped_motions(trip: Trajectory, stop: Stop, height: float, gravity: float) -> dict[str, StoppedMotion]:
    """Motions of "car" and "counterweight" through a stop with a deceleration in a shaft of a height [m].

    Raises `InputError` where there is nothing to stop.
    """
    begin, at = stop.time, moving_at(trip, stop)
    down, up = ("car", "counterweight") if at.velocity < 0.0 else ("counterweight", "car")
    shafts = {"car": None, "counterweight": height}
    speed, gaining = abs(at.velocity), at.acceleration * (1.0 if at.velocity > 0.0 else -1.0)
    slowed = _braked(begin, speed, gaining, stop.applied)
    # What moves down is slowed by an acceleration up, what moves up by one down.
    other = (slowed[0], [-one for one in slowed[1]])
    if max(slowed[1]) > gravity:
        other = _flight(slowed, speed, gaining, gravity) or other
    return {down: StoppedMotion(trip, shafts[down], *slowed), up: StoppedMotion(trip, shafts[up], *other)}


def _braked(begin: float, speed: float, gaining: float, deceleration: float) -> Pieces:
    """Slowing accelerations from a speed [m/s] that grows at a rate `gaining` [m/s2] down to rest."""
    plateau = (speed + 0.5 * RISE * gaining - deceleration * RISE) / deceleration
    if plateau > 0.0:
        times = [begin, begin + RISE, begin + RISE + plateau, begin + 2.0 * RISE + plateau]
        return times, [-gaining, deceleration, deceleration, 0.0]
    # Rest comes before the brake is fully on: it reaches what brings the speed to zero.
    return [begin, begin + RISE, begin + 2.0 * RISE], [-gaining, (speed + 0.5 * RISE * gaining) / RISE, 0.0]


def _flight(slowed: Pieces, speed: float, gaining: float, gravity: float) -> Pieces | None:
    """Accelerations, up positive, of the mass that moves up with a speed [m/s] when the other one is stopped harder than gravity.

    It lands where it hangs on taut ropes. None where it would not leave them by more than the landing itself takes.
    """
    times, slowing = slowed
    over = next(k for k, one in enumerate(slowing) if one > gravity)
    share = (gravity - slowing[over - 1]) / (slowing[over] - slowing[over - 1])
    loose = times[over - 1] + share * (times[over] - times[over - 1])  # from here on its ropes are slack
    held = (*times[:over], loose), [-one for one in (*slowing[:over], gravity)]
    velocity = PPoly(np.array([np.diff(held[1]) / np.diff(held[0]), held[1][:-1]]), np.array(held[0]))
    velocity = _integral(velocity, speed)
    risen, left = float(_integral(velocity, 0.0)(loose)), float(velocity(loose))
    travel = float(_travel(slowed, speed))

    def above(landing: float) -> float:
        """Height over that of taut ropes at which a landing ends that begins at a time."""
        flown, falling = landing - loose, left - gravity * (landing - loose)
        height = risen + left * flown - 0.5 * gravity * flown * flown - travel
        return height + 0.5 * LANDING * falling - gravity * LANDING * LANDING / 12.0

    first = max(loose + left / gravity, times[-1])  # its highest point
    if above(first) <= 0.0:
        return None
    landing = float(brentq(above, first, first + 10.0 + 2.0 * speed / gravity, xtol=1e-12))
    most = 0.5 * (4.0 * (gravity * (landing - loose) - left) / LANDING + gravity)
    return [*held[0], landing, landing + 0.5 * LANDING, landing + LANDING], [*held[1], -gravity, most, 0.0]


def _travel(slowed: Pieces, speed: float) -> float:
    """Way [m] from a speed [m/s] to rest."""
    times, slowing = slowed
    pieces = PPoly(np.array([-np.diff(slowing) / np.diff(times), -np.array(slowing[:-1])]), np.array(times))
    return float(_integral(_integral(pieces, speed), 0.0)(times[-1]))
