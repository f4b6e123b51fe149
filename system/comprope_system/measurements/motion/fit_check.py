"""The check of a recovered motion against its signal: it fits, but for single samples, or is taken as it is."""

from dataclasses import replace

import numpy as np

from .exact_motion import exact_motion
from .signal.local_misfit import excess
from .signal.position_signal import Floats, Mask, Signal
from .trip import Trip

OUTSTANDING = 3.0  # times the misfit of its neighbours by which a failed sample misses
ROUNDS = 4  # of leaving out the worst sample of each run of misses
MOST_SINGLE = 0.05  # share of samples that may go


def checked(trip: Trip, signal: Signal, span: tuple[float, float]) -> Trip:
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
    return exact_motion(signal, span, f"{by} (noise {1e3 * signal.noise:.2g} mm); the motion is taken as it is")


def _single(trip: Trip, signal: Signal, residual: Floats) -> Mask | None:
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


def _stand_out(left_out: Mask, residual: Floats) -> bool:
    """Whether samples left out are far off beside their neighbours: those of a motion that is missed are not."""
    kept, out = np.flatnonzero(~left_out), np.flatnonzero(left_out)
    after = np.searchsorted(kept, out)
    beside = np.maximum(residual[kept[np.maximum(after - 1, 0)]], residual[kept[np.minimum(after, len(kept) - 1)]])
    return bool(np.all(residual[out] > OUTSTANDING * beside))
