"""Several trips of one record as one motion."""

from itertools import pairwise

import numpy as np

from .signal.position_signal import Signal
from .trip import Piece, Sequence, Trip, constant, smooth_step


def joined(trips: list[Trip], breaks: list[float], signal: Signal) -> Trip:
    """One trip of several, which change at `breaks` [s], with equal levels at each rest between two."""
    levels = [(float(one.position(one.rest_before)), float(one.position(one.rest_after))) for one in trips]
    rests = [levels[0][0], *(0.5 * (one[1] + other[0]) for one, other in pairwise(levels)), levels[-1][1]]
    parts = []
    for one, (before, after), begin, end in zip(trips, levels, rests, rests[1:], strict=False):
        start, stop = one.rest_before, one.rest_after
        part = (*one.pieces, Piece(constant(begin - before), start, start))
        if np.isfinite(stop):
            part = (*part, Piece(smooth_step(start, stop, end - after - begin + before), start, stop))
        parts.append(part)
    curve = Sequence(tuple(breaks), tuple(parts))
    piece = Piece(curve, trips[0].rest_before, trips[-1].rest_after)
    remarks = tuple(dict.fromkeys(remark for one in trips for remark in one.remarks))
    noise = float(np.std(signal.position - piece.value(signal.time)))
    return Trip((piece,), noise, "trips", remarks)
