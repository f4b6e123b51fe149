"""A position signal made ready for recovery: its noise and resolution, held samples, spikes, and dense sampling averaged."""

from dataclasses import replace

import numpy as np

from comprope.errors import InputError

from .noise import local_noise, noise, resolution
from .position_signal import Floats, Mask, Signal
from .spikes import spikes

FEWEST = 20  # samples from which a motion can be estimated
BIN = 8e-3  # s; denser sampling is averaged to this interval, a fifth of the knots' spacing
COARSEST = 0.05  # m; a signal of larger steps, such as the number of a landing, shows no motion
HELD = 1.5  # median number of equal samples in a moving signal from which on its values are held by a slower device
LONG_HOLD = 10.0  # median holds; a value repeated for longer is that of a car at rest


def prepare(time: Floats, position: Floats, step: float | None = None) -> Signal:
    """The signal of the finite samples of `position` [m] at `time` [s], and of resolution `step` [m] if it does not show its own.

    Raises `InputError` if times do not increase or fewer than 20 samples are numbers.
    """
    known = np.isfinite(position)
    if time.ndim != 1 or time.shape != position.shape or not np.all(np.isfinite(time)):
        raise InputError("time: a finite number is needed in every row")
    if np.any(np.diff(time) <= 0.0):
        row = int(np.argmax(np.diff(time) <= 0.0)) + 2
        raise InputError(f"time = {time[row - 1]:g} s in row {row}: must be later than the row before")
    if known.sum() < FEWEST:
        raise InputError(f"position: {known.sum()} numbers; at least {FEWEST} are needed to estimate the motion of the car")
    t, x = time[known], position[known]
    step = resolution(x) if step is None else step
    t, x, held = _without_repetitions(t, x, min(step, COARSEST))
    step = resolution(x) if held else step
    if np.median(np.diff(t)) < 0.5 * BIN:
        dense = _signal(t, x, step)
        t, x = _averaged(t, x, spikes(dense))
    return replace(_signal(t, x, step), held=held)


def _signal(time: Floats, position: Floats, step: float) -> Signal:
    size = noise(time, position, step)
    return Signal(time, position, size, step, np.maximum(size, local_noise(time, position)))


def _without_repetitions(time: Floats, position: Floats, step: float) -> tuple[Floats, Floats, float]:
    """The samples at which a held signal changes, repeated at its interval where it rests; and that interval, 0 if not held.

    Only runs of equal values that end in a jump by more than three steps of the resolution count: a coarse signal of a slow
    car repeats values too, but changes by one step at a time.
    """
    first = np.concatenate(([0], np.flatnonzero(np.diff(position)) + 1))
    length = np.diff(np.append(first, len(position)))
    jumps = np.abs(np.diff(position[first])) > 3.5 * step
    inner = length[1:-1][jumps[:-1] & jumps[1:]]
    if len(inner) < FEWEST // 2 or (count := float(np.median(inner))) < HELD:
        return time, position, 0.0
    since = np.arange(len(position)) - np.repeat(first, length)
    rests = np.repeat(length, length) > LONG_HOLD * count
    kept = (since == 0) | (rests & (since % round(count) == 0))
    return time[kept], position[kept], float(np.median(np.diff(time))) * round(count)


def _averaged(time: Floats, position: Floats, left_out: Mask) -> tuple[Floats, Floats]:
    """Means over intervals of BIN, free of the curvature within an interval."""
    time, position = time[~left_out], position[~left_out]
    place = ((time - time[0]) / BIN).astype(np.int64)
    bins, at = np.unique(place, return_index=True)
    count = np.diff(np.append(at, len(time)))
    t, x = np.add.reduceat(time, at) / count, np.add.reduceat(position - position[0], at) / count + position[0]
    # The mean of a parabola over an interval exceeds its middle by a 24th of its second difference.
    bend = np.zeros(len(x))
    even = (np.diff(bins)[1:] == 1) & (np.diff(bins)[:-1] == 1)
    bend[1:-1] = np.where(even, x[:-2] - 2.0 * x[1:-1] + x[2:], 0.0)
    return t, x - bend / 24.0
