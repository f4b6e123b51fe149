"""Samples of a channel apart from the others, and steps that none of the others comes near: remarks, nothing is left out."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LEAST = 50  # samples that tell what is usual
SPIKE = 15.0  # usual deviations from the mean of both neighbours beyond which a sample lies apart
APART = 2.0  # times the difference of both neighbours that such a deviation exceeds
LONE = 3.0  # times the second largest step that a step must be to be no part of the motion
JUMP = 10.0  # usual steps that it must be as well
LASTING = 0.8  # share of such a step by which the level must differ after it, as it does when an instrument is knocked
WINDOW = 2.0  # s before and after it over which these levels are taken, or those of the whole record
MAD_FACTOR = 1.4826  # standard deviation over median absolute deviation of a normal distribution


def jump_remarks(time: Floats, values: Floats, unit: str) -> Iterator[str]:
    """Sentences about `values` (n,), in `unit`, at `time` (n,) [s], NaN where there is none."""
    known = np.isfinite(values)
    t, x = time[known], values[known]
    if len(x) < LEAST:
        return
    deviations = x[1:-1] - 0.5 * (x[2:] + x[:-2])
    usual = MAD_FACTOR * float(np.median(np.abs(deviations)))
    far = (np.abs(deviations) > SPIKE * usual) & (np.abs(deviations) > APART * np.abs(x[2:] - x[:-2]))
    if usual > 0.0 and far.any():
        size = float(np.abs(deviations[far]).max())
        count = "1 sample lies" if far.sum() == 1 else f"{far.sum()} samples lie"
        yield f"{count} apart from both neighbours, by up to {size:.3g} {unit}; fits leave out what noise does not explain"
    steps = np.abs(np.diff(x))
    k = int(np.argmax(steps))
    others = np.delete(steps, k)
    lone = steps[k] > LONE * others.max() and steps[k] > JUMP * float(np.median(others)) > 0.0
    near = (t > t[k] - WINDOW) & (t <= t[k + 1] + WINDOW)
    if lone and any(_shift(x[own], t[own] > t[k]) > LASTING * steps[k] for own in (near, np.ones(len(t), bool))):
        yield f"jumps by {steps[k]:.3g} {unit} at time = {t[k + 1]:.4g} s, far beyond its other steps: was the instrument moved?"


def _shift(values: Floats, after: NDArray[np.bool_]) -> float:
    """Difference of the levels of `values` (n,) where `after` is false and where it is true."""
    return float(abs(np.median(values[after]) - np.median(values[~after])))
