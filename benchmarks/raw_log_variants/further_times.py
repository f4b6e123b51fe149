"""Further times: clocks in several columns, numbers that are dates, coarse and uneven clocks, other columns of times."""

from collections.abc import Iterator
from datetime import timedelta

import numpy as np
import pandas as pd

from .variant import START, Variant, csv, inserted, other, text


def written_clocks(table: pd.DataFrame) -> Iterator[Variant]:
    """Dates and times of day in several columns, or as numbers."""
    stamps = [START + timedelta(microseconds=round(1e6 * one)) for one in table["time"]]
    thousandths = [one.microsecond // 1000 for one in stamps]
    clock = [f"{one:%H:%M:%S}" for one in stamps]
    exact = [f"{one:%H:%M:%S}.{ms:03d}" for one, ms in zip(stamps, thousandths, strict=True)]
    yield text("time: date and time in two columns", csv(inserted(table.assign(time=exact), 0, "date", "02.11.2026")))
    yield text("time: milliseconds in a column of their own", csv(inserted(table.assign(time=clock), 1, "ms", thousandths)))
    yield text("time: milliseconds beside seconds", csv(inserted(table.assign(time=clock), 1, "Milliseconds", thousandths)))
    digits = [f"{one:%Y%m%d%H%M%S}.{ms:03d}" for one, ms in zip(stamps, thousandths, strict=True)]
    yield text("time: digits of date and time", csv(table.assign(time=digits)))
    yield text("time: digits of the time of day", csv(table.assign(time=[one[8:] for one in digits])))
    late = [one + timedelta(seconds=45) for one in stamps]
    digits = [f"{one:%H%M%S}.{one.microsecond // 1000:03d}" for one in late]
    yield text("time: digits of the time of day, over a minute", csv(table.assign(time=digits)))
    summer = [one + timedelta(hours=1 if k > 700 else 0) for k, one in enumerate(stamps)]
    yield text("time: clock set forward", csv(table.assign(time=[one.isoformat(timespec="milliseconds") for one in summer])))
    winter = [one - timedelta(hours=1 if k > 700 else 0) for k, one in enumerate(stamps)]
    yield text("time: clock set back", csv(table.assign(time=[one.isoformat(timespec="milliseconds") for one in winter])))
    yield text("time: hundredths", csv(table.assign(time=[one[:-1] for one in exact])))
    yield text("time: tenths", csv(table.assign(time=[one[:-2] for one in exact])))
    comma = [f"{one:%d.%m.%Y %H:%M:%S},{ms:03d}" for one, ms in zip(stamps, thousandths, strict=True)]
    yield text("time: dates with a comma, semicolons", csv(table.assign(time=comma), sep=";", decimal=","))
    named = [f"{one:%d-%b-%Y %H:%M:%S}.{ms:03d}" for one, ms in zip(stamps, thousandths, strict=True)]
    yield text("time: named months", csv(table.assign(time=named)))
    words = [f"{one:%b %d %H:%M:%S}.{ms:03d}" for one, ms in zip(stamps, thousandths, strict=True)]
    yield text("time: month and day without a year", csv(table.assign(time=words)))


def other_clocks(table: pd.DataFrame) -> Iterator[Variant]:
    """Coarse, uneven and drifting clocks, and columns that are named as times and are none."""
    t = table["time"].to_numpy()
    random = np.random.default_rng(3)
    cycle = np.round(9.0 + random.random(len(t)), 3)
    yield text("time: cycle time of a controller beside it", csv(inserted(table, 1, "cycle_time", cycle)))
    yield text("time: time to landing beside it", csv(inserted(table, 1, "time to landing [s]", np.round(t[-1] - t, 3))))
    yield text("time: door time beside it", csv(inserted(table, 1, "door_time", np.where(t < 10, 0.0, 3.2))))
    yield other("time: single precision from a large number", table.assign(time=np.float32(1e5 + t).astype(float)))
    yield text("time: in bursts", csv(table.assign(time=np.floor(t / 0.4) * 0.4)))
    yield other("time: jitter", table.assign(time=np.round(t + 0.005 * random.random(len(t)), 4)))
    yield text("time: rate in kS/s above", "Sample rate: 0.025 kS/s\n\n" + csv(table.drop(columns="time")))
    yield text("time: rate with the unit in its name", "Sampling rate [kHz]: 0.025\n\n" + csv(table.drop(columns="time")))
    yield text("time: interval with the unit in its name", "Sampling interval (ms): 40\n\n" + csv(table.drop(columns="time")))
    yield text("time: interval in a row of cells", "Delta t;0,04;s\n\n" + csv(table.drop(columns="time"), sep=";", decimal=","))
    yield text("time: another rate above", "Sample rate: 1000 Hz\n\n" + csv(table))
    counted = table.rename(columns={"time": "sample"}).assign(sample=np.arange(1, len(t) + 1)).drop(index=range(300, 310))
    yield text("time: sample numbers from 1 with gaps", "Sample rate: 25 Hz\n\n" + csv(counted))
    yield text("time: stated in s, is ms", csv(table.assign(time=1e3 * t).rename(columns={"time": "Time [s]"})))
    yield text("time: stated in ms, is s", csv(table.rename(columns={"time": "Time [ms]"})))
    ticks = np.round(1e6 * t).astype(np.int64)
    yield text("time: milliseconds as whole numbers from a large one", csv(table.assign(time=ticks // 1000 + 884_201_337)))
    yield text("time: microseconds that overflow", csv(table.assign(time=(ticks + 4_280_000_000) % 2**32)))
