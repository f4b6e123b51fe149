"""Faults of the files: how clean channels become rows of a CSV file."""

from collections.abc import Mapping

import numpy as np

from .tower import Floats

Rows = dict[str, Floats]  # columns in the units of the file, with time


def uneven_sampling(rows: Rows, by: Mapping[str, float], rng: np.random.Generator) -> Rows:
    """Each sample is taken somewhat early or late, by up to `jitter` of the interval."""
    time = rows["time"]
    moved = time + np.median(np.diff(time)) * rng.uniform(-by["jitter"], by["jitter"], len(time))
    moved[0] = time[0]
    return {name: moved if name == "time" else np.interp(moved, time, values) for name, values in rows.items()}


def gaps(rows: Rows, by: Mapping[str, float], rng: np.random.Generator) -> Rows:
    """Each channel is lost for some time, once or twice."""
    time, found = rows["time"], dict(rows)
    for name in set(rows) - {"time", "car_position"}:
        values = rows[name].copy()
        for begin in rng.uniform(time[0], time[-1], rng.integers(1, 3)):
            values[(time >= begin) & (time < begin + by["seconds"])] = np.nan
        found[name] = values
    return found


def clock_offset(rows: Rows, by: Mapping[str, float], rng: np.random.Generator) -> Rows:
    """The sensors' clock is late against the drive's."""
    time = rows["time"]
    drive = ("time", "car_position")
    return {name: values if name in drive else np.interp(time - by["seconds"], time, values) for name, values in rows.items()}


def outliers(rows: Rows, by: Mapping[str, float], rng: np.random.Generator, noise: Mapping[str, float]) -> Rows:
    """Some samples of each channel are far off."""
    found = dict(rows)
    for name, size in noise.items():
        hit = rng.random(len(rows[name])) < by["share"]
        far = rng.choice((-1.0, 1.0), len(hit)) * rng.uniform(0.2, 1.0, len(hit)) * by["times_noise"] * size
        found[name] = rows[name] + hit * far
    return found
