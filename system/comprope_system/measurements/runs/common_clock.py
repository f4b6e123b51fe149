"""Channels with clocks of their own on one axis of times."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
SAME_TIME = 1e-6  # s between samples of two clocks that are samples at one time


def on_one_axis(
    car: Floats, read: dict[str, tuple[Floats, Floats]]
) -> tuple[Floats, dict[str, Floats], dict[str, NDArray[np.bool_]]]:
    """The clock of the channels if they share one, otherwise the times of all, with NaN between a channel's own samples."""
    if not read:
        return car, {}, {}
    clocks = [time for time, _ in read.values()]
    if all(len(one) == len(clocks[0]) and np.allclose(one, clocks[0], rtol=0.0, atol=SAME_TIME) for one in clocks[1:]):
        return clocks[0], {column: values for column, (_, values) in read.items()}, {}
    each = np.unique(np.concatenate(clocks))
    new = np.diff(each, prepend=-np.inf) > SAME_TIME
    union, place = each[new], np.cumsum(new) - 1
    values, sampled = {}, {}
    for column, (time, own) in read.items():
        at = place[np.searchsorted(each, time)]
        values[column] = np.full(len(union), np.nan)
        values[column][at] = own
        sampled[column] = np.zeros(len(union), bool)
        sampled[column][at] = True
    return union, values, sampled
