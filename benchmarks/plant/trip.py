"""A jerk-limited trip of seven phases, and the smooth position, velocity and acceleration along it."""

from itertools import pairwise

import numpy as np

from .tower import Floats

SPEED, ACCELERATION, JERK = 2.5, 0.8, 0.8
REST, AFTER = 3.0, 8.0


def trip(start: float, stop: float, step: float, before: float = 0.0) -> tuple[Floats, Floats]:
    """Times [k] from -before on, and the car's position, velocity and acceleration [k, 3], at rest before and after the trip."""
    ramp, hold = ACCELERATION / JERK, SPEED / ACCELERATION - ACCELERATION / JERK
    cruise = abs(stop - start) / SPEED - SPEED / ACCELERATION - ACCELERATION / JERK
    if cruise < 0.0:
        raise ValueError(f"a trip of {abs(stop - start)} m does not reach {SPEED} m/s")
    durations = np.array([REST + before, ramp, hold, ramp, cruise, ramp, hold, ramp, AFTER])
    jerks = np.copysign(JERK, stop - start) * np.array([0, 1, 0, -1, 0, -1, 0, 1, 0])
    knots = np.concatenate([[0.0], np.cumsum(durations)]) - before
    first = -2 * round(before / step / 2)
    time = np.arange(first, round(knots[-1] / step / 2) * 2 + 1) * step
    motion = np.zeros((len(time), 3))
    state = np.array([start, 0.0, 0.0])
    for (begin, end), jerk in zip(pairwise(knots), jerks, strict=True):
        inside = (time >= begin) & (time <= end + step)
        motion[inside] = _after(state, time[inside] - begin, jerk)
        state = _after(state, np.array([end - begin]), jerk)[0]
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
