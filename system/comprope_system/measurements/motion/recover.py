"""Recovers the motion of the car, or of the counterweight, from its measured position.

Each motion between two rests is recovered as a smooth trip. Where that misses the signal by more than its noise allows, or
the motion is none from rest to rest over some distance, the motion is taken as it is: the smoothest curve within
the noise of every sample. What is returned has therefore been compared with the signal.
"""

from dataclasses import replace
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from comprope.errors import InputError

from .local_misfit import excess
from .local_smoothing import smooth_within_noise
from .motion_spans import motion_spans
from .position_signal import HARD_STOP, Signal, no_motion, prepare, spikes
from .smooth_trip import recover_smooth_trip
from .trip import ENDS_UNDER_WAY, Piece, Sequence, Trip, constant, continued, smooth_step

Floats = NDArray[np.float64]
Motion = Literal["auto", "exact"]
MOTIONS: tuple[Motion, ...] = get_args(Motion)

REST = 0.1  # s at the start or end of a record that count as rest
MARGIN = 1.0  # s before and after a motion is seen beyond the noise, within which it may have begun and ended
LONGEST_REST = 20.0  # s of a rest that take part in the recovery of the motion before or after it; the rest of it adds nothing
ROUNDS, MOST_SINGLE = 4, 0.05  # of leaving out the worst sample of each run of misses; share of samples that may go
OUTSTANDING = 3.0  # times the misfit of its neighbours by which a failed sample misses
TOO_MANY = 0.1  # share of samples left out beyond which the rest is not believed either
FAST = 50.0  # m/s2; beyond a safety gear's deceleration, so that an impact or a failure of the sensor is worth a remark
NO_TRIP = "the car returns to its height without a rest, or moved in a gap of the record; the motion is taken as it is"
MOST_LEFT_OUT = 0.01  # share of samples left out as failures of the sensor without a remark


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
    return replace(trip, remarks=tuple(dict.fromkeys((*_of_signal(signal, left_out), *trip.remarks))))


def _recovered(signal: Signal, good: NDArray[np.bool_], motion: Motion) -> Trip:
    spans = motion_spans(signal.of(good))
    if not spans:
        return _checked(_rest(signal.of(good)), signal.of(good), (float(signal.time[0]), float(signal.time[-1])))
    whole = spans[0][0], spans[-1][1]
    if motion == "exact":
        return _exact(signal.of(good), whole, "")
    # A window reaches near to the motions before and after, which begin earlier and end later than is seen, or into a long rest.
    margins = [min(MARGIN, 0.5 * (after[0] - one[1])) for one, after in pairwise(spans)]
    begins = [-np.inf, *(stop + margin for (_, stop), margin in zip(spans, margins, strict=False))]
    ends = [*(start - margin for (start, _), margin in zip(spans[1:], margins, strict=True)), np.inf]
    trips = []
    for begin, span, end in zip(begins, spans, ends, strict=True):
        inside = (signal.time >= max(begin, span[0] - LONGEST_REST)) & (signal.time <= min(end, span[1] + LONGEST_REST))
        trips.append(_one(signal.of(inside), good[inside], span))
    middles = [0.5 * (one[1] + other[0]) for one, other in pairwise(spans)]
    joined = _joined(trips, middles, signal.of(good)) if len(trips) > 1 else trips[0]
    return _checked(joined, signal.of(good), whole)


def _one(signal: Signal, good: NDArray[np.bool_], span: tuple[float, float]) -> Trip:
    """The trip of a signal with one motion, at rest or not before and after it."""
    kept = signal.of(good)
    departs, arrives = _rests(signal, span)
    smooth = recover_smooth_trip(signal, arrives) if departs else None
    if smooth is None:
        return _exact(kept, span, NO_TRIP if departs else "")
    return _checked(smooth, kept, span)


def _rests(signal: Signal, span: tuple[float, float]) -> tuple[bool, bool]:
    """Whether the record begins and ends at rest."""
    return span[0] - float(signal.time[0]) >= REST, float(signal.time[-1]) - span[1] >= REST


def _checked(trip: Trip, signal: Signal, span: tuple[float, float]) -> Trip:
    """The trip if it fits the signal, otherwise the motion as it is, with a remark."""
    residual = np.abs(signal.position - trip.position(signal.time))
    over = excess(signal, trip.position(signal.time))
    if over.max() <= 1.0:
        return trip
    single = _single(trip, signal, residual)
    if single is not None:
        size = f"up to {1e3 * residual[single].max():.3g} mm from the recovered motion"
        return replace(trip, remarks=(*trip.remarks, f"{single.sum()} single samples are left out, {size}"))
    worst = int(np.argmax(residual * (over > 1.0)))
    miss = 1e3 * float(residual[worst])
    what = {"rest": "rest", "trips": "a series of trips"}.get(trip.kind, "a smooth trip")
    by = f"{what} misses the measured position by up to {miss:.3g} mm at time = {signal.time[worst]:.4g} s"
    return _exact(signal, span, f"{by} (noise {1e3 * signal.noise:.2g} mm); the motion is taken as it is")


def _single(trip: Trip, signal: Signal, residual: Floats) -> NDArray[np.bool_] | None:
    """Single samples without which the trip fits: failures of the sensor; None if a few of them are not all that misses."""
    good = np.ones(len(residual), bool)
    for _ in range(ROUNDS):
        kept = signal.of(good)
        misses = excess(kept, trip.position(kept.time)) > 1.0
        if not misses.any():
            failed = np.all(residual[~good] > signal.hidden) and _stand_out(~good, residual)
            return ~good if failed else None
        edges = np.flatnonzero(np.diff(np.concatenate(([0], misses.astype(np.int8), [0])))).reshape(-1, 2)
        at = np.flatnonzero(good)
        good[[at[first + int(np.argmax(residual[at[first:after]]))] for first, after in edges]] = False
        if np.mean(~good) > MOST_SINGLE:
            break
    return None


def _stand_out(left_out: NDArray[np.bool_], residual: Floats) -> bool:
    """Whether samples left out are far off beside their neighbours: those of a motion that is missed are not."""
    kept, out = np.flatnonzero(~left_out), np.flatnonzero(left_out)
    after = np.searchsorted(kept, out)
    beside = np.maximum(residual[kept[np.maximum(after - 1, 0)]], residual[kept[np.minimum(after, len(kept) - 1)]])
    return bool(np.all(residual[out] > OUTSTANDING * beside))


def _exact(signal: Signal, span: tuple[float, float], remark: str) -> Trip:
    """The smoothest motion within the noise, at rest outside `span` where the record reaches beyond it."""
    first, last = float(signal.time[0]), float(signal.time[-1])
    departs, arrives = _rests(signal, span)
    start = max(span[0] - MARGIN, first) if departs else first
    stop = min(span[1] + MARGIN, last) if arrives else last
    piece = smooth_within_noise(signal, start, stop, departs, arrives)
    if not arrives:
        piece = continued(piece)
    residual = signal.position - piece.value(signal.time)
    remarks = [remark] if remark else []
    if (over := excess(signal, piece.value(signal.time))).max() > 1.0:
        worst = int(np.argmax(np.abs(residual) * (over > 1.0)))
        where = f"at time = {signal.time[worst]:.4g} s"
        remarks.append(f"the recovered motion misses the measured position by {1e3 * abs(residual[worst]):.3g} mm {where}")
    fastest = float(np.abs(piece.derivative(signal.time, 2)).max())
    if fastest > FAST:
        unseen = f"samples {1e3 * signal.interval:.3g} ms apart do not show its course"
        remarks.append(f"the motion reaches {fastest:.3g} m/s2: an impact, or a failure of the sensor; {unseen}")
    if not departs:
        remarks.append("the record begins under way")
    if not arrives:
        remarks.append(ENDS_UNDER_WAY)
        if signal.held:
            remarks.append(f"its last {signal.held:.2g} s are extrapolated, uncertain by some {1e3 * signal.held**2:.2g} mm")
    return Trip((piece,), float(np.std(residual)), "exact", tuple(remarks))


def _rest(signal: Signal) -> Trip:
    level = float(np.mean(signal.position))
    noise = max(float(np.std(signal.position)), signal.noise)
    return Trip((Piece(constant(level), float(signal.time[0]), float(signal.time[0])),), noise, "rest")


def _joined(trips: list[Trip], breaks: list[float], signal: Signal) -> Trip:
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


def _of_signal(signal: Signal, left_out: NDArray[np.bool_]) -> list[str]:
    """Sentences about the signal itself."""
    found = []
    if signal.held:
        hidden = f"between them a hard stop may move the car by {1e3 * HARD_STOP * signal.held**2 / 8.0:.2g} mm unseen"
        found.append(
            f"the signal holds its values for {signal.held:.3g} s; only the samples at which it changes are used, and {hidden}"
        )
    if (share := float(np.mean(left_out))) > MOST_LEFT_OUT:
        found.append(f"{100.0 * share:.2g} % of the samples continue no motion and are left out")
    return found
