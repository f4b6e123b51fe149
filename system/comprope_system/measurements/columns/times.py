"""Times of samples in seconds from the first of them."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..files.raw_table import RawTable
from ..units import TIMES

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class TimeAxis:
    """Times (n,) [s] from the first of them, NaN where a row has none.

    `origin` [s] is the first time on the clock of the file, of the `kind` "relative" (the logger's own), "clock" (time of day) or
    "date" (with day). `unit` is the unit of a numeric time, None for stamps; `sure` is False if that unit was assumed.
    """

    seconds: Floats
    origin: float
    kind: str
    unit: str | None = None
    sure: bool = True
    remark: str | None = None

    def in_unit(self, unit: str) -> "TimeAxis":
        """The same numbers read in another unit."""
        factor = TIMES[unit] / TIMES[self.unit or "s"]
        return replace(self, seconds=self.seconds * factor, origin=self.origin * factor, unit=unit, sure=True)


def row_times(table: RawTable, count: int, rate: float) -> TimeAxis:
    """Times of `count` samples at a constant rate [Hz], for a table without a column of times."""
    return TimeAxis(
        np.arange(count) / rate, 0.0, "relative", "s", remark=f"no column of times; {rate:g} samples per second are taken"
    )
