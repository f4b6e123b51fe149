"""A jerk-limited trip of seven phases, and the smooth position, velocity and acceleration along it."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .tower import Floats


@dataclass(frozen=True)
class Limits:
    """What trips keep to [m/s, m/s2, m/s3], and how long [s] the car is at rest before and after them."""

    speed: float
    acceleration: float
    jerk: float
    rest: float = 3.0
    after: float = 8.0


def trip(start: float, stop: float, limits: Limits, step: float, every: int, before: float = 0.0) -> tuple[Floats, Floats]:
    """Times [k] from -before on, and the car's position, velocity and acceleration [k, 3], at rest before and after the trip.

    One of `every` times is recorded, and time 0 among them.
    """
    speed, acceleration, jerk = limits.speed, limits.acceleration, limits.jerk
    ramp, hold = acceleration / jerk, speed / acceleration - acceleration / jerk
    cruise = abs(stop - start) / speed - speed / acceleration - acceleration / jerk
    if cruise < 0.0:
        raise ValueError(f"a trip of {abs(stop - start)} m does not reach {speed} m/s")
    durations = np.array([limits.rest + before, ramp, hold, ramp, cruise, ramp, hold, ramp, limits.after])
    jerks = np.copysign(jerk, stop - start) * np.array([0, 1, 0, -1, 0, -1, 0, 1, 0])
    knots = np.concatenate([[0.0], np.cumsum(durations)]) - before
    first = -every * round(before / step / every)
    time = np.arange(first, round(knots[-1] / step / every) * every + 1) * step
    motion = np.zeros((len(time), 3))
    state = np.array([start, 0.0, 0.0])
    for (begin, end), rate in zip(pairwise(knots), jerks, strict=True):
        inside = time >= begin
        motion[inside] = _after(state, time[inside] - begin, rate)
        state = _after(state, np.array([end - begin]), rate)[0]
    return time, motion


def _after(state: Floats, t: Floats, jerk: float) -> Floats:
    position, velocity, acceleration = state
    return np.stack(
        [
            position + t * (velocity + t * (acceleration / 2 + t * jerk / 6)),
            velocity + t * (acceleration + t * jerk / 2),
            acceleration + t * jerk,
        ],
        axis=-1,
    )
