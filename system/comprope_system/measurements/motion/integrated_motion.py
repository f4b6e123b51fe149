"""Position relative to the start of the record, integrated from a speed or an acceleration.

What a sensor shows at rest before the trip is its offset. Where the record begins and ends at rest, an acceleration is also
corrected so that the speed is zero at both. What remains is a random walk, whose size is estimated from the signal's noise.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from comprope.errors import InputError

from .motion_spans import motion_spans
from .signal.position_signal import Signal
from .signal.preparation import prepare
from .signal.spikes import TOP_SPEED, spikes

Floats = NDArray[np.float64]

SHORTEST_REST = 0.5  # s at rest that determine an offset
LARGEST_OFFSET = {1: 0.05, 2: 0.5}  # m/s, m/s2: a sensor at rest shows less; more is a record that begins under way
LARGEST_ACCELERATION = 50.0  # m/s2; safety gears and buffers stay below 2.5 g, so that more is another unit
DRIFTS, SHARE_AT_REST = 6.0, 0.05  # speed that counts as zero: in standard deviations of the drift, or share of the top speed
UNITS = {1: "m/s", 2: "m/s2"}


@dataclass(frozen=True)
class Integrated:
    """Position over time, and the standard deviation [m] of its drift over the record."""

    signal: Signal
    drift: float


def integrate(time: Floats, values: Floats, times: int) -> Integrated:
    """Position (n,) [m] from a speed (`times` = 1) or an acceleration (2) at `time` (n,) [s].

    Raises `InputError` for a record that does not begin at rest, or values that no elevator reaches.
    """
    measured = prepare(time, values)
    measured = measured.of(~spikes(measured))
    largest, limit = float(np.abs(measured.position).max()), {1: TOP_SPEED, 2: LARGEST_ACCELERATION}[times]
    if largest > limit:
        raise InputError(f"{largest:.4g} {UNITS[times]}: at most {limit:g} {UNITS[times]} is accepted; check its unit")
    before, after = _rests(measured)
    offset = float(np.mean(measured.position[before])) if before.any() else np.inf
    if abs(offset) > LARGEST_OFFSET[times]:
        raise InputError(
            f"the record does not begin at rest: at least {SHORTEST_REST:g} s below {LARGEST_OFFSET[times]:g} {UNITS[times]} are"
            " needed, because the speed before it is unknown"
        )
    t, rate = measured.time, np.where(before, 0.0, measured.position - offset)
    step, duration = measured.interval, float(t[-1] - t[0])
    walk = measured.noise * (step * duration) ** 0.5
    if times == 2:
        rate, walk = _speed(t, rate, after, walk)
    if after.any() and abs(float(np.mean(rate[after]))) <= LARGEST_OFFSET[1]:
        rate[after] = 0.0
    noise = max(walk, measured.noise * step)
    return Integrated(Signal(t, cumulative_trapezoid(rate, t, initial=0.0), noise, 0.0, np.full(len(t), noise)), noise)


def _speed(time: Floats, acceleration: Floats, after: NDArray[np.bool_], walk: float) -> tuple[Floats, float]:
    """Speed (n,) [m/s], made zero at rest after the trip by a linear drift, and the standard deviation of the position [m].

    `walk` is the standard deviation of the integrated noise [m/s]. Without acceleration a car may rest or cruise: it rests
    where the speed is near zero.
    """
    speed = cumulative_trapezoid(acceleration, time, initial=0.0)
    duration = float(time[-1] - time[0])
    end = float(np.mean(speed[after])) if after.any() else np.inf
    if abs(end) > max(DRIFTS * walk, SHARE_AT_REST * float(np.abs(speed).max())):
        return speed, walk * duration / 3.0**0.5  # of an integrated random walk
    since = np.clip((time - time[0]) / (float(np.mean(time[after])) - time[0]), 0.0, None)
    return speed - end * since, walk * duration / 12.0**0.5  # of an integrated random walk that returns to zero


def _rests(measured: Signal) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Samples (n,) before the first change of the signal and after the last, none where they are too short."""
    t = measured.time
    spans = motion_spans(measured)
    first, last = (spans[0][0], spans[-1][1]) if spans else (float(t[-1]), float(t[-1]))
    before, after = t <= first, t >= last
    return before & (first - t[0] >= SHORTEST_REST), after & (t[-1] - last >= SHORTEST_REST)
