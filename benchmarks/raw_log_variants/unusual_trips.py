"""Motions other than one trip from rest to rest, measured with noise of half a millimetre; each with the motion behind it."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from .variant import Variant, csv, text

Floats = NDArray[np.float64]

FINE, STRIDE = 1e-3, 40  # s between points of a motion; points between samples
NOISE, RADIUS = 5e-4, 0.4  # m
JERK_TIME = 0.4  # s, standard deviation of the ramp of a speed


def unusual_trips(table: pd.DataFrame) -> Iterator[Variant]:
    """All variants of this file; the plain table is not used, but for its names."""
    for name, (start, speed) in _motions().items():
        position = start + FINE * np.cumsum(speed)
        yield _measured(name, position, speed, list(table.columns))


def _measured(name: str, position: Floats, speed: Floats, names: list[str]) -> Variant:
    random, time = np.random.default_rng(len(name)), FINE * np.arange(len(position))
    rows = slice(None, None, STRIDE)
    count = len(time[rows])
    swing = 10.0 * np.sin(4.0 * time[rows]) * (np.abs(np.cumsum(np.abs(speed)))[rows] > 0.0)
    columns = [time[rows], position[rows] + NOISE * random.standard_normal(count)]
    columns += [swing + 0.2 * random.standard_normal(count) for _ in range(3)]
    columns += [0.02 * random.standard_normal(count), speed[rows] / RADIUS + 0.01 * random.standard_normal(count)]
    found = pd.DataFrame(dict(zip(names, columns, strict=True))).round(4)
    variant = text(name, csv(found))
    return Variant(variant.name, variant.file, variant.write, motion=position[rows])


def _speeds(*parts: tuple[float, float]) -> Floats:
    """Speeds [m/s] of parts of this length [s], with smooth ramps between them."""
    raw = np.concatenate([np.full(round(seconds / FINE), value) for seconds, value in parts])
    return np.asarray(gaussian_filter1d(raw, JERK_TIME / FINE, mode="nearest"))


def _motions() -> dict[str, tuple[float, Floats]]:
    """Height at the start [m] and speeds [m/s] by name."""
    up, rest = (12.0, 2.5), (4.0, 0.0)
    usual = _speeds(rest, up, rest)
    stop = round(10.0 / FINE)
    t = FINE * np.arange(len(usual))
    emergency = np.where(t < 10.0, usual, np.clip(2.5 - 3.0 * (t - 10.0), 0.0, None))
    gear = np.where(t < 10.0, usual, np.clip(2.5 - 12.0 * (t - 10.0), 0.0, None))
    bounce = np.where(t < 10.0, usual, 2.5 * np.exp(-3.0 * (t - 10.0)) * np.cos(2.0 * np.pi * 4.0 * (t - 10.0)))
    sink = usual + np.where(t > 18.0, -0.003 / 0.5 * np.exp(-(t - 18.0) / 0.5), 0.0)
    back = usual + np.where((t > 2.0) & (t < 2.4), -0.01, 0.0)
    shaken = usual + 1e-3 * 2.0 * np.pi * 3.0 * np.cos(2.0 * np.pi * 3.0 * t) * (usual > 0.5)
    return {
        "trip: emergency stop": (2.0, emergency), "trip: safety gear": (2.0, gear), "trip: buffer that bounces": (2.0, bounce),
        "trip: re-levelled by 12 mm": (2.0, _speeds(rest, up, (3.0, 0.0), (0.6, 0.02), rest)),
        "trip: creeps the last 15 cm": (2.0, _speeds(rest, up, (3.0, 0.05), rest)),
        "trip: inspection speed": (20.0, _speeds(rest, (25.0, 0.3), rest)),
        "trip: begins under way": (2.0, usual[round(8.0 / FINE) :]),
        "trip: ends under way": (2.0, usual[:stop]),
        "trip: under way all the time": (2.0, usual[round(7.0 / FINE) : stop + 3000]),
        "trip: up and back at once": (2.0, _speeds(rest, (6.0, 2.0), (6.0, -2.0), rest)),
        "trip: two trips": (2.0, _speeds(rest, (6.0, 2.0), (3.0, 0.0), (6.0, -2.0), rest)),
        "trip: five trips": (2.0, _speeds(rest, *[one for k in range(5) for one in ((5.0, 2.0 * (-1) ** k), (6.0, 0.0))])),
        "trip: 30 cm": (10.0, _speeds(rest, (1.0, 0.3), rest)), "trip: one floor": (10.0, _speeds(rest, (3.0, 1.0), rest)),
        "trip: two minutes of rest": (2.0, _speeds((60.0, 0.0), up, (60.0, 0.0))),
        "trip: sinks by 3 mm when loaded": (2.0, sink), "trip: rolls back by 4 mm": (2.0, back),
        "trip: slows down on the way": (2.0, _speeds(rest, (6.0, 2.5), (6.0, 1.0), rest)),
        "trip: stops on the way for half a second": (2.0, _speeds(rest, (5.0, 2.0), (2.0, 0.0), (5.0, 2.0), rest)),
        "trip: swings to and fro": (20.0, 0.3 * np.sin(2.0 * np.pi * 0.25 * t) * (t > 4.0) * (t < 16.0)),
        "trip: vibrates by 1 mm at 3 Hz": (2.0, shaken),
        "trip: drifts by 1 mm/s": (2.0, usual + 1e-3),
    }  # fmt: skip
