"""MDF files, versions 3 and 4, of automotive and industrial loggers."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from asammdf import MDF

from ..file_format import FileFormat
from ..raw_table import RawColumn, RawTable, unique_names


def read(path: Path, stated: FileFormat) -> RawTable:
    """The channels of all groups, or of the group with the stated number, each with the clock of its group."""
    found = []
    with MDF(path) as file:
        groups: Any = file.groups
        for k, group in enumerate(groups):
            if stated.sheet not in (None, str(k)):
                continue
            master = file.masters_db.get(k)
            for index, channel in enumerate(group.channels):
                if index != master:
                    signal = file.get(channel.name, group=k, index=index, ignore_invalidation_bits=True)
                    found.append((signal, k))
    signals = [(signal, k) for signal, k in found if np.ndim(signal.samples) == 1 and len(signal.samples)]
    bare = [signal.name for signal, _ in signals]
    names = unique_names([one.name if bare.count(one.name) == 1 else f"{k}/{one.name}" for one, k in signals])
    columns = [
        RawColumn(name, _values(signal), signal.unit or None, pd.Series(np.asarray(signal.timestamps, float)))
        for name, (signal, _) in zip(names, signals, strict=True)
    ]
    return RawTable(tuple(columns))


def _values(signal: Any) -> pd.Series:
    """The samples of a channel, NaN where the logger marked them as invalid."""
    samples = signal.samples
    if samples.dtype.kind in "SO":
        return pd.Series(samples.astype(str))
    invalid = signal.invalidation_bits
    return pd.Series(samples if invalid is None or not invalid.any() else np.where(invalid, np.nan, samples))
