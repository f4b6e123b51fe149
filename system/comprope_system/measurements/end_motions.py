"""The motion of both rope ends from the columns of a run: car and counterweight together, and their lateral displacement."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comprope.errors import InputError

from .anchoring import MISMATCH, Landings, Record, anchored
from .integrated_motion import integrate
from .lead_in import run_up_time, with_run_up
from .local_misfit import excess
from .motion_columns import ENDS, VERTICAL, acting_columns, idle_columns, lateral_column
from .position_signal import prepare, resolution, spikes
from .recover import Motion, recover_signal, recover_trip
from .trip import Trip

Floats = NDArray[np.float64]

SUM_OF_HEIGHTS = 0.01  # m between the sum of both heights and the shaft's height that is worth a remark


@dataclass(frozen=True)
class MotionOptions:
    """How the motion is recovered, and the heights of the car [m] at the start and end of the record, if known."""

    motion: Motion = "auto"
    landings: Landings = field(default_factory=Landings)


@dataclass(frozen=True)
class EndMotions:
    """Height of car and counterweight, outward displacement of both rope ends where measured, and remarks about all."""

    car: Trip
    counterweight: Trip
    lateral: dict[str, Trip]
    remarks: tuple[str, ...]


def recover_ends(
    file: Path, table: pd.DataFrame, height: float, options: MotionOptions | None = None, described: Iterable[str] = ()
) -> EndMotions:
    """The motions of a table with the column `time` [s] and motion columns [m, m/s, m/s2], in a shaft of this height [m].

    `described` are columns with another meaning. Raises `InputError` where no column gives a motion, where its height is
    unknown, or where a signal is none of an elevator's; it names `file`.
    """
    try:
        return _recovered(table.drop(columns=[name for name in described if name in table]), height, options or MotionOptions())
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def _recovered(table: pd.DataFrame, height: float, options: MotionOptions) -> EndMotions:
    names = sorted(name for name in acting_columns(table) if not name.endswith("lateral_displacement"))
    if not names:
        header, others = ", ".join(map(str, table.columns)), "car_speed, car_acceleration or the counterweight's will do"
        raise InputError(f"no column car_position; the header has {header}; {others}")
    time = table["time"].to_numpy(float)
    if len(names) == 2:
        car, counterweight = _both(table, height, options)
    else:
        car, counterweight = _single(table, names[0], height, options)
    duration = run_up_time(car, float(time[0]), height)
    lateral = {end: _sideways(table, name) for end in ENDS if (name := lateral_column(table, end))}
    remarks = [*car.remarks, *counterweight.remarks, *(one for trip in lateral.values() for one in trip.remarks)]
    remarks += [f"{name}: not used; {', '.join(names)} determines the motion" for name in idle_columns(table, [])]
    if duration:
        remarks.append(f"the ends run up from rest for {duration:.3g} s before the record, because it begins under way")
    begin = float(time[0])
    car, counterweight = with_run_up(car, begin, duration), with_run_up(counterweight, begin, duration)
    return EndMotions(car, counterweight, lateral, tuple(dict.fromkeys(remarks)))


def _sideways(table: pd.DataFrame, name: str) -> Trip:
    """Outward displacement of a rope end [m]."""
    return _of_column(name, lambda: recover_trip(table["time"].to_numpy(float), table[name].to_numpy(float), "exact"))


def _of_column(name: str, recover: Callable[[], Trip]) -> Trip:
    """The trip of a column, which its remarks and errors name."""
    try:
        trip = recover()
    except InputError as error:
        text = str(error).removeprefix("position: ").removeprefix("position ")
        raise InputError(text if text.startswith("time") else f"{name}: {text}") from None
    return replace(trip, remarks=tuple(f"{name}: {one}" for one in trip.remarks))


def _single(table: pd.DataFrame, name: str, height: float, options: MotionOptions) -> tuple[Trip, Trip]:
    """Motions of car and counterweight from a column of one; the other one mirrors it in the shaft."""
    end, quantity = name.split("_", 1)
    landings = options.landings if end == "car" else _opposite(options.landings, height)
    time, values = table["time"].to_numpy(float), table[name].to_numpy(float)
    trip = _of_column(name, lambda: _anchored_trip(time, values, VERTICAL[quantity], height, replace(options, landings=landings)))
    other = replace(trip.mirrored(height), remarks=())
    return (trip, other) if end == "car" else (other, trip)


def _opposite(landings: Landings, height: float) -> Landings:
    return Landings(*(None if one is None else height - one for one in (landings.start, landings.end)))


def _anchored_trip(time: Floats, values: Floats, integrations: int, height: float, options: MotionOptions) -> Trip:
    if integrations:
        integrated = integrate(time, values, integrations)
        trip = recover_signal(integrated.signal, options.motion)
        known = options.landings.start is not None and options.landings.end is not None
        drift = "" if known else f"; its height at the end is uncertain by about {1e3 * integrated.drift:.2g} mm"
        trip = replace(trip, remarks=(*trip.remarks, f"integrated to a height{drift}"))
    else:
        trip = recover_trip(time, values, options.motion)
    # Positions at the samples, not between: a spline may overshoot.
    positions = trip.position(time[np.isfinite(values)])
    record = Record(trip, float(time[0]), float(time[-1]), float(positions.min()), float(positions.max()), bool(integrations))
    return anchored(record, options.landings, height)


def _both(table: pd.DataFrame, height: float, options: MotionOptions) -> tuple[Trip, Trip]:
    """Motions from both positions: the car's, and the sum of both, which is constant while the hoist ropes are tight.

    The counterweight is the sum less the car, so that it mirrors the car exactly wherever the two signals do.
    """
    time, car, other = (table[name].to_numpy(float) for name in ("time", "car_position", "counterweight_position"))
    total = prepare(time, car + other)
    total = total.of(~spikes(total.time, total.position, total.noise, total.rounded))
    level = float(np.median(total.position))
    mirrors = excess(total, np.full(len(total.time), level)).max() <= 1.0
    measured = np.where(np.isfinite(car), car, level - other) if mirrors else car
    trip = _of_column("car_position", lambda: _anchored_trip(time, measured, 0, height, options))
    shift = _shift(trip, time, measured)
    if mirrors:
        counterweight = replace(trip.mirrored(level + shift), remarks=())
    else:
        # Less the recovered car, not the measured one: the counterweight then has no noise but its own.
        apart = recover_signal(prepare(time, other + trip.position(time), resolution(other[np.isfinite(other)])), "exact")
        pieces = (*trip.mirrored(0.0).pieces, *apart.pieces)
        largest = 1e3 * float(np.ptp(apart.position(time)))
        remark = f"counterweight_position: does not mirror the car's; their sum varies by {largest:.3g} mm"
        counterweight = Trip(pieces, apart.noise, apart.kind, (remark,))
    sum_of_heights = float((trip.position(time[:1]) + counterweight.position(time[:1]))[0])
    if abs(shift) > MISMATCH:
        remark = f"counterweight_position: shifted by {height - sum_of_heights:.4g} m with the car: they add up to the shaft's height"
        counterweight = counterweight.scaled(1.0, height - sum_of_heights)
        counterweight = replace(counterweight, remarks=(*counterweight.remarks, remark))
    elif abs(sum_of_heights - height) > SUM_OF_HEIGHTS:
        said = f"counterweight_position: the heights of car and counterweight add up to {sum_of_heights:.4g} m at the start"
        counterweight = replace(counterweight, remarks=(*counterweight.remarks, f"{said}; the shaft's height is {height:g} m"))
    return trip, counterweight


def _shift(trip: Trip, time: Floats, car: Floats) -> float:
    """What anchoring has added to the car's heights [m]; raises `InputError` if it has changed their sign."""
    known = np.isfinite(car)
    heights = trip.position(time[known])
    if np.ptp(heights) > 1.0 and np.corrcoef(heights, car[known])[0, 1] < 0.0:
        raise InputError("car_position counts downwards: counterweight_position beside it is not accepted; leave that column out")
    return float(np.median(heights - car[known]))
