"""Times in other units and notations."""

from collections.abc import Iterator
from datetime import datetime, timedelta

import numpy as np
import pandas as pd

from .variant import START, Variant, csv, text


def numeric_times(table: pd.DataFrame) -> Iterator[Variant]:
    """Numeric times in other units, sample numbers, or none."""
    t = table["time"].to_numpy()
    epoch = (START - datetime(1970, 1, 1)).total_seconds()
    numbers: dict[str, tuple[str, object]] = {
        "ms in the name": ("time_ms", 1e3 * t), "ms in brackets": ("Time [ms]", 1e3 * t), "ms unlabelled": ("time", 1e3 * t),
        "us unlabelled": ("time", np.round(1e6 * t).astype(int)), "min in brackets": ("time [min]", t / 60.0),
        "min unlabelled": ("time", t / 60.0), "h unlabelled": ("time", t / 3600.0), "from 1000 s": ("time", 1000.0 + t),
        "from -1 s": ("time", t - 1.0), "epoch in ms": ("timestamp", np.round(1e3 * (epoch + t)).astype(np.int64)),
        "epoch in us": ("timestamp", np.round(1e6 * (epoch + t)).astype(np.int64)),
        "epoch in ns": ("timestamp", np.round(1e6 * (epoch + t)).astype(np.int64) * 1000), "epoch in s": ("time", epoch + t),
        "days of Excel": ("time", 46328.0 + 0.3833463 + t / 86400.0), "days of MATLAB": ("time", 740288.0 + 0.38 + t / 86400.0),
        "fraction of a day": ("time", 0.3833463 + t / 86400.0), "sample numbers, no rate": ("sample", np.arange(len(t))),
        "sample numbers called time": ("time", np.arange(len(t))), "time in a word": ("Zeit", t), "unknown name": ("Abszisse", t),
    }  # fmt: skip
    for name, (column, values) in numbers.items():
        changed = table.rename(columns={"time": column})
        changed[column] = values
        yield text(f"time: {name}", csv(changed))
    changed = table.rename(columns={"time": "sample"}).assign(sample=np.arange(len(t)))
    yield text("time: sample numbers, rate above", "Sample rate: 25 Hz\n\n" + csv(changed))
    yield text("time: sample numbers, rate stated", csv(changed), "[file]\nrate = 25.0\n")
    yield text("time: none, rate above", "Sampling interval;40 ms\n" + csv(table.drop(columns="time"), sep=";", decimal=","))
    yield text("time: none", csv(table.drop(columns="time")))


def time_stamps(table: pd.DataFrame) -> Iterator[Variant]:
    """Dates and times of day."""
    t = table["time"].to_numpy()
    stamps = [START + timedelta(microseconds=round(1e6 * one)) for one in t]
    night = [one + timedelta(hours=14, minutes=47, seconds=45) for one in stamps]
    forms: dict[str, list[str]] = {
        "ISO with Z": [f"{one.isoformat(timespec='milliseconds')}Z" for one in stamps],
        "ISO with a zone": [f"{one.isoformat(timespec='milliseconds')}+01:00" for one in stamps],
        "day first": [f"{one:%d.%m.%Y %H:%M:%S}.{one.microsecond // 1000:03d}" for one in stamps],
        "month first, AM": [f"{one:%m/%d/%Y %I:%M:%S}.{one.microsecond // 1000:03d} {one:%p}" for one in stamps],
        "year first": [f"{one:%Y/%m/%d %H:%M:%S}.{one.microsecond // 1000:03d}" for one in stamps],
        "minutes and seconds": [f"{one:%M:%S}.{one.microsecond // 1000:03d}" for one in stamps],
        "colon before milliseconds": [f"{one:%H:%M:%S}:{one.microsecond // 1000:03d}" for one in stamps],
        "over midnight": [f"{one:%H:%M:%S}.{one.microsecond // 1000:03d}" for one in night],
        "over midnight with the date": [f"{one:%d.%m.%Y %H:%M:%S}.{one.microsecond // 1000:03d}" for one in night],
        "whole seconds only": [f"{one:%H:%M:%S}" for one in stamps],
    }
    for name, column in forms.items():
        yield text(f"time: {name}", csv(table.assign(time=column)))
    commas = [f"{one:%H:%M:%S},{one.microsecond // 1000:03d}" for one in stamps]
    yield text("time: comma before milliseconds", csv(table.assign(time=commas), sep=";", decimal=","))
    yield text("time: comma before milliseconds, between commas", csv(table.assign(time=commas)).replace('"', ""))


def time_faults(table: pd.DataFrame) -> Iterator[Variant]:
    """Times that go back, repeat, or are missing."""
    t = table["time"].to_numpy()
    yield text("time: goes back", csv(pd.concat([table[:400], table])))
    yield text("time: one row twice", csv(pd.concat([table[:400], table[399:]])))
    yield text("time: a cell missing", csv(table.assign(time=np.where(table.index == 300, np.nan, t))))
    gap = table.drop(index=range(300, 310))
    yield text("time: ten rows missing", csv(gap))
