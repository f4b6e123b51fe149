"""Recovers the motion of the car, or of the counterweight, from its measured position.

Each motion between two rests is recovered as a smooth trip. Where that misses the signal by more than its noise allows, or
the motion is none from rest to rest over some distance, the motion is taken as it is: the smoothest curve within
the noise of every sample. What is returned has therefore been compared with the signal.
"""

from dataclasses import replace
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from comprope.errors import InputError

from .exact_motion import MARGIN, exact_motion, rests
from .fit_check import checked
from .motion_spans import motion_spans
from .signal.position_signal import Mask, Signal
from .signal.preparation import prepare
from .signal.spikes import spikes
from .signal_quality import no_motion, signal_remarks
from .smoothing.smooth_trip import recover_smooth_trip
from .trip import Piece, Trip, constant
from .trip_sequence import joined

Motion = Literal["auto", "exact"]
MOTIONS: tuple[Motion, ...] = get_args(Motion)

LONGEST_REST = 20.0  # s of a rest that take part in the recovery of the motion before or after it; the rest of it adds nothing
TOO_MANY = 0.1  # share of samples left out beyond which the rest is not believed either
NO_TRIP = "the car returns to its height without a rest, or moved in a gap of the record; the motion is taken as it is"


def recover_trip(time: ArrayLike, position: ArrayLike, motion: Motion = "auto") -> Trip:
    """The motion estimated from `position` [m] at `time` [s], both (n,), unevenly sampled, with gaps (NaN) and outliers.

    With `motion` "exact" no smooth trip is looked for. Raises `InputError` if times do not increase, fewer than 20 samples are
    numbers, or the position jumps as no car does.
    """
    return recover_signal(prepare(np.asarray(time, dtype=float), np.asarray(position, dtype=float)), motion)


def recover_signal(signal: Signal, motion: Motion = "auto") -> Trip:
    """The motion behind a prepared signal; see `recover_trip`."""
    left_out = spikes(signal)
    if left_out.mean() > TOO_MANY:
        share = f"{100.0 * left_out.mean():.2g} % of the samples continue no motion"
        raise InputError(f"position: {share}; at most {100.0 * TOO_MANY:g} % is accepted")
    if sentence := no_motion(signal, left_out):
        raise InputError(sentence)
    trip = _recovered(signal, ~left_out, motion)
    return replace(trip, remarks=tuple(dict.fromkeys((*signal_remarks(signal, left_out), *trip.remarks))))


def _recovered(signal: Signal, good: Mask, motion: Motion) -> Trip:
    spans = motion_spans(signal.of(good))
    if not spans:
        return checked(_rest(signal.of(good)), signal.of(good), (float(signal.time[0]), float(signal.time[-1])))
    whole = spans[0][0], spans[-1][1]
    if motion == "exact":
        return exact_motion(signal.of(good), whole, "")
    # A window reaches near to the motions before and after, which begin earlier and end later than is seen, or into a long rest.
    margins = [min(MARGIN, 0.5 * (after[0] - one[1])) for one, after in pairwise(spans)]
    begins = [-np.inf, *(stop + margin for (_, stop), margin in zip(spans, margins, strict=False))]
    ends = [*(start - margin for (start, _), margin in zip(spans[1:], margins, strict=True)), np.inf]
    trips = []
    for begin, span, end in zip(begins, spans, ends, strict=True):
        inside = (signal.time >= max(begin, span[0] - LONGEST_REST)) & (signal.time <= min(end, span[1] + LONGEST_REST))
        trips.append(_one(signal.of(inside), good[inside], span))
    middles = [0.5 * (one[1] + other[0]) for one, other in pairwise(spans)]
    whole_trip = joined(trips, middles, signal.of(good)) if len(trips) > 1 else trips[0]
    return checked(whole_trip, signal.of(good), whole)


def _one(signal: Signal, good: Mask, span: tuple[float, float]) -> Trip:
    """The trip of a signal with one motion, at rest or not before and after it."""
    kept = signal.of(good)
    departs, arrives = rests(signal, span)
    smooth = recover_smooth_trip(signal, arrives) if departs else None
    if smooth is None:
        return exact_motion(kept, span, NO_TRIP if departs else "")
    return checked(smooth, kept, span)


def _rest(signal: Signal) -> Trip:
    level = float(np.mean(signal.position))
    noise = max(float(np.std(signal.position)), signal.noise)
    return Trip((Piece(constant(level), float(signal.time[0]), float(signal.time[0])),), noise, "rest")
