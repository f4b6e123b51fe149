"""Synthetic records of a building: its displacement by height in a long-period earthquake, or in gusts of wind."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comprope.errors import InputError

from .modal_building import ModalBuilding
from .random_series import random_lines
from .spectra import ground_acceleration, wind_force

Floats = NDArray[np.float64]
Kind = Literal["earthquake", "wind"]
STEP = 0.02  # s
LEVELS = 11  # heights of a record
RISE, FALL = 0.15, 0.35  # shares of an earthquake's duration over which it grows and decays
GUSTS_RISE = 20.0  # s over which wind grows from calm
DAMPING = {"earthquake": 0.02, "wind": 0.01}  # ratio; usual values for steel towers at strong and at moderate amplitudes
SHEAR_BEAM = (1.0, 1.0 / 3.0)  # periods of the modes over that of the first
LIMITS = {  # least, largest, unit
    "duration": (10.0, 3600.0, " s"), "peak": (1e-4, 20.0, ""), "soil_period": (0.2, 20.0, " s"), "speed": (1.0, 80.0, " m/s"),
    "damping": (1e-4, 0.5, ""), "period": (0.2, 30.0, " s"), "width": (1.0, 500.0, " m"),
}  # fmt: skip


@dataclass(frozen=True)
class RecordOptions:
    """A synthetic record.

    `duration` [s]; `peak` is the largest acceleration of the ground [m/s2] of an earthquake, or the root-mean-square displacement
    [m] of the top in wind; `period` [s] is that of the building's first mode, of which the second has a third; `damping` ratio of
    both, by default 0.02 in an earthquake and 0.01 in wind; `soil_period` [s]; mean wind `speed` [m/s] and the building's `width`
    [m] across it. Equal seeds give equal records.
    """

    kind: Kind
    period: float
    peak: float
    duration: float = 120.0
    damping: float | None = None
    soil_period: float = 4.0
    speed: float = 25.0
    width: float = 40.0
    seed: int = 0

    def __post_init__(self) -> None:
        """Raises `InputError` with all values that are not accepted."""
        wrong = [] if self.kind in DAMPING else [f"kind = {self.kind}: earthquake or wind is accepted"]
        for name, (low, high, unit) in LIMITS.items():
            value = getattr(self, name)
            if value is not None and not low <= value <= high:
                wrong.append(f"{name} = {value:g}{unit}: {low:g} to {high:g}{unit} is accepted")
        if self.seed < 0:
            wrong.append(f"seed = {self.seed}: a whole number from 0 is accepted")
        if wrong:
            raise InputError("\n".join(wrong))

    @property
    def building(self) -> ModalBuilding:
        """The building's modes."""
        damping = DAMPING[self.kind] if self.damping is None else self.damping
        return ModalBuilding(tuple(self.period * one for one in SHEAR_BEAM), damping)


@dataclass(frozen=True)
class SyntheticRecord:
    """Displacements (n, heights) [m] at times (n,) [s] and heights [m], and the acceleration of the ground (n,) [m/s2]."""

    times: Floats
    heights: Floats
    displacements: Floats
    ground_acceleration: Floats

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the heights' columns."""
        return tuple(f"level_{k}" for k in range(len(self.heights)))

    def to_dataframe(self) -> pd.DataFrame:
        """`time [s]`, and a column `level_0 [m]` and so on for each height, lowest first."""
        named = {f"{name} [m]": self.displacements[:, k] for k, name in enumerate(self.columns)}
        return pd.DataFrame({"time [s]": self.times} | named)


def synthetic_record(options: RecordOptions, base: float, top: float) -> SyntheticRecord:
    """The record of a building that stands on its base and reaches up to its top (heights above the bottom landing [m])."""
    heights = np.linspace(base, top, LEVELS)
    share = (heights - base) / (top - base)
    make = _earthquake if options.kind == "earthquake" else _wind
    times, ground, acceleration, coordinates = make(options, top - base)
    shapes = np.array([options.building.shape(mode, share) for mode in range(len(coordinates))])
    return SyntheticRecord(times, heights, ground[:, None] + coordinates.T @ shapes, acceleration)


def _earthquake(options: RecordOptions, height: float) -> tuple[Floats, Floats, Floats, Floats]:
    """Times, displacement and acceleration of the ground, and modal coordinates (modes, n), all from rest."""
    random = np.random.default_rng(options.seed)
    lines = random_lines(lambda f: ground_acceleration(f, options.soil_period), options.duration, STEP, random)
    slow = lines.filtered(lambda f: np.asarray(-1.0 / (2.0 * np.pi * f) ** 2, complex))  # the displacement
    x, v, a = (slow.series(k) for k in range(3))
    e, e1, e2 = envelope(lines.times, RISE * options.duration, FALL * options.duration)
    acceleration = e * a + 2.0 * e1 * v + e2 * x
    factor = options.peak / float(np.abs(acceleration).max())
    acceleration *= factor
    building = options.building
    responses = [building.ground_response(mode, acceleration, STEP) for mode in range(len(building.periods))]
    return lines.times, factor * e * x, acceleration, np.array(responses)


def _wind(options: RecordOptions, height: float) -> tuple[Floats, Floats, Floats, Floats]:
    """The same in gusts, which act on each mode on their own and leave the ground at rest."""
    random, building, area = np.random.default_rng(options.seed), options.building, options.width * height
    found = []
    for mode in range(len(building.periods)):
        force = random_lines(lambda f: wind_force(f, options.speed, area), options.duration, STEP, random)
        found.append(force.filtered(lambda f, mode=mode: building.receptance(mode, f)).series())  # type: ignore[misc]
    times = np.asarray(STEP * np.arange(len(found[0])))
    signs = np.array([building.shape(mode, np.ones(1))[0] for mode in range(len(found))])
    top = signs @ np.array(found)
    grown = envelope(times, min(GUSTS_RISE, 0.25 * options.duration), 0.0)[0]
    still = np.zeros(len(times))
    return times, still, still, np.asarray(options.peak / float(np.std(top)) * np.array(found) * grown)


def envelope(times: Floats, rise: float, fall: float) -> tuple[Floats, Floats, Floats]:
    """Factor from 0 to 1 over `rise` [s] and back over the last `fall` [s], by half cosines, and its two derivatives."""
    found = []
    for clock, length, sign in ((times, rise, 1.0), (times[-1] - times, fall, -1.0)):
        turn = np.pi * np.clip(clock / length, 0.0, 1.0) if length > 0.0 else np.full(len(times), np.pi)
        rate = np.pi / length if length > 0.0 else 0.0
        moving = (turn > 0.0) & (turn < np.pi)
        value = 0.5 * (1.0 - np.cos(turn))
        found.append((value, moving * sign * 0.5 * rate * np.sin(turn), moving * 0.5 * rate**2 * np.cos(turn)))
    (a, a1, a2), (b, b1, b2) = found
    return a * b, a1 * b + a * b1, a2 * b + 2.0 * a1 * b1 + a * b2
