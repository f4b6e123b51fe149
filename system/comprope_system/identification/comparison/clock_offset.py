"""Clocks that disagree: a delay that all channels share against the car's position."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ..settings import CLOCK_OFFSET, PAIRED_RECORDS, WHITENING
from .paired_records import Record, by_column

Floats = NDArray[np.float64]


def clock(records: Sequence[Record]) -> Iterator[str]:
    """A delay that all channels share: the drive's log and the sensors have different clocks.

    A wrong plant shifts the swinging too, but each channel otherwise; so all must agree, and two must be sure.
    """
    found = [one for group in by_column(records) if (one := pooled_delay(group))]
    if len(found) < 2:
        return
    late, deviation = np.array(found).T
    common = float(np.average(late, weights=deviation**-2.0))
    agree = np.abs(late - common) < 3.0 * deviation + CLOCK_OFFSET.model_uncertainty
    sure = np.abs(late) > 3.0 * deviation
    if abs(common) > CLOCK_OFFSET.min_offset and agree.all() and sure.sum() >= 2:
        word = "late" if common > 0.0 else "early"
        yield (
            f"all channels are {1e3 * abs(common):.0f} ms {word} against the car's position: "
            "the clocks of drive log and sensors are probably offset"
        )


def pooled_delay(group: Sequence[Record]) -> tuple[float, float] | None:
    """How late a channel is over all runs [s], and its standard deviation; None where that cannot be seen."""
    found = [one for record in group if (one := delay(record))]
    if not found:
        return None
    late, deviation = np.array(found).T
    mean = float(np.average(late, weights=deviation**-2.0))
    scatter = float(np.std(late)) / max(len(late) - 1, 1) ** 0.5
    return mean, max(scatter, float((deviation**-2.0).sum()) ** -0.5)


def delay(record: Record) -> tuple[float, float] | None:
    """How late [s] a channel follows its prediction, and the standard deviation of that; None where they are never alike.

    That is where both are most alike; what is left there counts as noise that is new every WHITENING.discrepancy_time seconds.
    """
    both = record.both
    if both.sum() < 5 * PAIRED_RECORDS.min_samples or np.std(record.measured[both]) < PAIRED_RECORDS.min_variation * record.noise:
        return None
    t = record.run.time[both]
    step = max(float(np.median(np.diff(t))), 2e-3)
    grid = np.arange(t[0], t[-1], step)
    m, p = (np.interp(grid, t, values[both]) for values in (record.measured, record.predicted))
    m, p = m - m.mean(), p - p.mean()
    reach = min(int(CLOCK_OFFSET.max_offset / step), len(grid) // 4)
    found = np.array([_correlation(m, p, k) for k in range(-reach, reach + 1)])
    best = int(np.argmax(found))
    if found[best] < CLOCK_OFFSET.min_correlation or best in (0, len(found) - 1):
        return None
    low, top, high = found[best - 1 : best + 2]
    late = step * (best - reach + 0.5 * (low - high) / (low - 2.0 * top + high))
    left = float(np.std(m)) * max(1.0 - top**2, 0.0) ** 0.5
    return late, max(
        left / float(np.std(np.gradient(p, grid))) / float((grid[-1] - grid[0]) / WHITENING.discrepancy_time) ** 0.5, 1e-3
    )


def _correlation(m: Floats, p: Floats, late: int) -> float:
    """Correlation of m with p moved later by a number of samples."""
    a, b = (m[late:], p[: len(p) - late]) if late >= 0 else (m[:late], p[-late:])
    return float(a @ b / np.sqrt((a @ a) * (b @ b) + 1e-300))
