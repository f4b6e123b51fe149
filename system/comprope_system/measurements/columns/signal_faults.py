"""Samples of a signal that are no measurement: infinite, sentinels, clipped, dropped out, held.

Each rule takes the numbers of a column (n,), NaN where there is none, and returns which samples are at fault, with a remark.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Finding = tuple[Mask, str]

# What loggers write where there is no value: nines, the ends of whole-number ranges, and the largest numbers of IEEE and LabVIEW.
SENTINELS = frozenset(
    [float(10**k - 1) for k in range(2, 10)]
    + [99.99, 999.9, 999.99, 9999.9, 9999.99, 999.25, 9999.25]
    + [2.0**k - 1.0 for k in (12, 14, 15, 16, 23, 24, 31, 32)]
    + [2.0**k for k in (15, 23, 31)]
    + [1e10, 1e20, 1e30, 1e36, 1e37, 9.9e37, 9.91e37, 1e38, 1e300, 1.7976931348623157e308, 3.4028234663852886e38]
)
LARGEST = 1e10  # beyond which no channel measures in any unit
FAR = 5.0  # ranges of the other samples by which a value must lie outside of them to be no measurement
MOST_SENTINELS = 10  # different values that are looked at, the farthest first: a logger has one or two
REPEATED = 3  # samples of one far value that are no measurement, whatever it is
PLATEAU = 4  # samples of one value in a row that are a plateau, if it is entered or left by a jump
JUMP = 3.0  # resolutions of the signal; a smooth peak of a coarse signal is entered by one
DROPOUT_JUMP = 8.0  # usual steps from one sample to the next
STUCK = 10  # equal samples in a row that noise does not allow
REPEATING = 0.2  # share of samples, beside those stuck, that repeat the one before, from which on resolution hides noise
CLIPPED_SHARE = 0.005  # least share of samples at the limit of a channel that is clipped
HELD_SHARE = 0.9  # of changes that fall on every k-th sample of a channel that is held
LEAST_MOVING = 20  # samples that tell how a signal changes from one to the next


def remove_faults(values: Floats, rules: tuple[Callable[[Floats], Finding | None], ...]) -> tuple[Floats, list[str]]:
    """The values with NaN for samples at fault by one of the rules, applied one after the other, and remarks."""
    found, remarks = values.copy(), []
    for rule in rules:
        if finding := rule(found):
            found[finding[0]] = np.nan
            remarks.append(finding[1])
    return found, remarks


def infinite(values: Floats) -> Finding | None:
    """Samples that are infinite."""
    at = np.isinf(values)
    return (at, f"{_samples(at)} infinite and left out") if at.any() else None


def sentinels(values: Floats) -> Finding | None:
    """Samples of a value that stands for "no measurement": a known one, or one that repeats, far outside of all others."""
    known = values[np.isfinite(values)]
    if len(known) < LEAST_MOVING:
        return None
    low, middle, high = np.percentile(known, (25.0, 50.0, 75.0))
    distinct, counts = np.unique(known, return_counts=True)
    named = np.isin(np.abs(distinct), list(SENTINELS)) | (np.abs(distinct) >= LARGEST)
    suspects = np.flatnonzero(named | ((counts >= REPEATED) & (np.abs(distinct - middle) > FAR * (high - low))))
    suspects = suspects[np.argsort(-np.abs(distinct[suspects] - middle))][:MOST_SENTINELS]
    odd = [float(distinct[k]) for k in sorted(suspects) if _is_far(distinct[k], known[known != distinct[k]])]
    if not odd:
        return None
    at = np.isin(values, odd)
    shown = ", ".join(f"{one:.10g}" for one in odd[:3])
    return at, f"{_samples(at)} {shown}, which stands for no measurement, and left out"


def _is_far(value: float, rest: Floats) -> bool:
    """Whether a value lies outside of the others by several times their range."""
    if not len(rest):
        return False
    inner = np.percentile(rest, (1.0, 99.0))
    return bool(abs(value - np.median(rest)) > FAR * max(float(inner[1] - inner[0]), 1e-12))


def dropped_out(values: Floats) -> Finding | None:
    """Stretches of one value, entered and left by jumps, or long in a noisy signal: the instrument showed nothing for a while.

    A long one may be at the beginning or the end, where the end of the rope is beyond the sensor.
    """
    moved = _steps(values)
    if moved is None:
        return None
    usual = float(np.median(moved[moved > 0.0]))
    long = sum(stop - start - 1 for start, stop in _plateaus(values, STUCK))
    noisy = int(np.sum(moved == 0.0)) - long < REPEATING * (len(moved) - long)
    at = np.zeros(len(values), bool)
    for start, stop in _plateaus(values, REPEATED):
        before, after = _neighbour(values, start, -1), _neighbour(values, stop - 1, 1)
        beside = [one for one in (before, after) if one is not None]
        steps = [abs(values[start] - one) for one in beside]
        jumps = len(beside) == 2 and min(steps) > max(DROPOUT_JUMP * usual, 2.0 * abs(beside[0] - beside[1]))
        stuck = stop - start >= STUCK and noisy and max(steps, default=0.0) > JUMP * usual
        if jumps or stuck:
            at[start:stop] = True
    return (at, f"{_samples(at)} stuck at one value between jumps: dropped out, and left out") if at.any() else None


def clipped(values: Floats) -> Finding | None:
    """Samples at the largest or smallest value, if the signal stays there and arrives by a jump: beyond its range."""
    moved = _steps(values)
    if moved is None:
        return None
    resolution = float(moved[moved > 0.0].min())
    at = np.zeros(len(values), bool)
    for limit in (np.nanmin(values), np.nanmax(values)):
        for start, stop in _plateaus(values, PLATEAU):
            near = [one for one in (_neighbour(values, start, -1), _neighbour(values, stop - 1, 1)) if one is not None]
            if values[start] == limit and any(abs(limit - one) >= JUMP * resolution for one in near):
                at |= values == limit
    if at.sum() < max(CLIPPED_SHARE * np.isfinite(values).sum(), PLATEAU):
        return None
    shown = " and ".join(f"{one:.6g}" for one in np.unique(values[at]))
    return at, f"{_samples(at)} clipped at {shown} and left out: the range of the instrument is too small"


def held(values: Floats) -> Finding | None:
    """Samples that repeat the one before, where a signal is updated only every k-th sample: only its updates are measurements."""
    known = np.flatnonzero(np.isfinite(values))
    if len(known) < LEAST_MOVING or known[-1] - known[0] + 1 != len(known):
        return None
    changes = known[1:][np.diff(values[known]) != 0.0]
    if len(changes) < LEAST_MOVING or len(changes) > 0.6 * len(known):
        return None
    period = int(np.median(np.diff(changes)))
    if period < 2 or len(changes) < HELD_SHARE * len(known) / (period + 0.5):
        return None
    phase = np.bincount(changes % period, minlength=period)
    if phase.max() < HELD_SHARE * len(changes):
        return None
    at = np.isfinite(values)
    at[known[0]] = False
    at[changes] = False
    return at, f"updated only every {period} samples and held in between; only the updates are used"


def _steps(values: Floats) -> Floats | None:
    """Sizes of the steps from one sample to the next, None if too few are not zero."""
    known = values[np.isfinite(values)]
    steps = np.abs(np.diff(known))
    return steps if (steps > 0.0).sum() >= LEAST_MOVING else None


def _plateaus(values: Floats, least: int) -> list[tuple[int, int]]:
    """Start and end of each stretch of at least `least` equal values in a row."""
    edges = np.flatnonzero(np.r_[True, values[1:] != values[:-1], True])
    long = np.flatnonzero((np.diff(edges) >= least) & np.isfinite(values[edges[:-1]]))
    return [(int(edges[k]), int(edges[k + 1])) for k in long]


def _neighbour(values: Floats, at: int, direction: int) -> float | None:
    """The nearest number beside a sample on one side, None if there is none."""
    side = values[at + 1 :] if direction > 0 else values[:at][::-1]
    known = np.flatnonzero(np.isfinite(side[:LEAST_MOVING]))
    return float(side[known[0]]) if len(known) else None


def _samples(at: Mask) -> str:
    count = int(at.sum())
    return "1 sample is" if count == 1 else f"{count} samples are"


CHANNEL_RULES = (infinite, sentinels, held, dropped_out, clipped)
MOTION_RULES = (infinite, sentinels)
