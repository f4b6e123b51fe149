"""The motion of both rope ends from the signals of a run: car and counterweight together, and their lateral displacement."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError

from ..motion.anchoring import Landings, Record, anchored
from ..motion.integrated_motion import integrate
from ..motion.recover import Motion, recover_signal, recover_trip
from ..motion.run_up import run_up_time, with_run_up
from ..motion.signal.local_misfit import excess
from ..motion.signal.noise import resolution
from ..motion.signal.position_signal import Signal
from ..motion.signal.preparation import prepare
from ..motion.signal.spikes import spikes
from ..motion.trip import Trip
from .motion_column import MotionSignal

Floats = NDArray[np.float64]

INTEGRATIONS = {"position": 0, "speed": 1, "acceleration": 2}
SUM_OF_HEIGHTS = 0.01  # m between the sum of both heights and the shaft's height that is worth a remark


@dataclass(frozen=True)
class EndSignals:
    """What was measured of the rope's ends: the car, the counterweight or both, and outward displacements [m] by end."""

    car: MotionSignal
    counterweight: MotionSignal | None
    lateral: Mapping[str, MotionSignal]


@dataclass(frozen=True)
class EndMotions:
    """Height of car and counterweight, outward displacement of both rope ends where measured, and remarks about all."""

    car: Trip
    counterweight: Trip
    lateral: dict[str, Trip]
    remarks: tuple[str, ...]


def recover_ends(signals: EndSignals, height: float, motion: Motion, landings: Landings, file: str) -> EndMotions:
    """The motions of the rope's ends in a shaft of this height [m].

    `landings` are heights of the car, where they are known. Raises `InputError`, which names the `file`, where the height of a
    motion is unknown or a signal is none of an elevator's.
    """
    try:
        return _recovered(signals, height, motion, landings)
    except InputError as error:
        raise InputError("\n".join(f"{file}: {line}" for line in str(error).splitlines())) from None


def _recovered(signals: EndSignals, height: float, motion: Motion, landings: Landings) -> EndMotions:
    car = _named(signals.car, lambda: _anchored_trip(signals.car, height, motion, landings))
    if signals.counterweight is None:
        counterweight = replace(car.mirrored(height), remarks=())
    else:
        counterweight = _beside(signals.counterweight, car, height)
    lateral = {end: _sideways(signal) for end, signal in signals.lateral.items()}
    remarks = [remark for trip in (car, counterweight, *lateral.values()) for remark in trip.remarks]
    begin = float(signals.car.time[0])
    duration = run_up_time(car, begin, height)
    if duration:
        remarks.append(f"the ends run up from rest for {duration:.3g} s before the record, because it begins under way")
    car, counterweight = with_run_up(car, begin, duration), with_run_up(counterweight, begin, duration)
    return EndMotions(car, counterweight, lateral, tuple(dict.fromkeys(remarks)))


def _sideways(signal: MotionSignal) -> Trip:
    """Outward displacement of a rope end [m]."""
    return _named(signal, lambda: recover_trip(signal.time, signal.value, "exact"))


def _named(signal: MotionSignal, recover: Callable[[], Trip]) -> Trip:
    """The trip of a signal, whose column its remarks and errors name."""
    try:
        trip = recover()
    except InputError as error:
        text = str(error).removeprefix("position: ").removeprefix("position ")
        raise InputError(text if text.startswith("time") else f"{signal.column}: {text}") from None
    return replace(trip, remarks=tuple(f"{signal.column}: {one}" for one in trip.remarks))


def _anchored_trip(signal: MotionSignal, height: float, motion: Motion, landings: Landings) -> Trip:
    """The motion of the car with its heights above the bottom landing."""
    if integrations := INTEGRATIONS[signal.quantity]:
        integrated = integrate(signal.time, signal.value, integrations)
        trip = recover_signal(integrated.signal, motion)
        known = landings.start is not None and landings.end is not None
        drift = "" if known else f"; its height at the end is uncertain by about {1e3 * integrated.drift:.2g} mm"
        trip = replace(trip, remarks=(*trip.remarks, f"integrated to a height{drift}"))
    else:
        trip = recover_trip(signal.time, signal.value, motion)
    # Positions at the samples, not between: a spline may overshoot.
    positions = trip.position(signal.time[np.isfinite(signal.value)])
    first, last = float(signal.time[0]), float(signal.time[-1])
    record = Record(trip, first, last, float(positions.min()), float(positions.max()), bool(integrations))
    return anchored(record, landings, height)


def _beside(signal: MotionSignal, car: Trip, height: float) -> Trip:
    """The motion of the counterweight from its position: the car's mirrored, and where they differ the sum of both.

    The sum is constant while the hoist ropes are tight; it is taken with the recovered car, not the measured one, so
    that the counterweight has no noise but its own.
    """
    step = resolution(signal.value[np.isfinite(signal.value)])
    total = prepare(signal.time, signal.value + car.position(signal.time), step)
    level = _constant(total)
    if level is not None:
        counterweight, remarks = car.mirrored(level), []
    else:
        apart = _named(signal, lambda: recover_signal(total, "exact"))
        largest = 1e3 * float(np.ptp(apart.position(total.time)))
        own = [one.removeprefix(f"{signal.column}: ") for one in apart.remarks]
        remarks = [f"does not mirror the car; the sum of both heights varies by {largest:.3g} mm", *own]
        counterweight = Trip((*car.mirrored(0.0).pieces, *apart.pieces), apart.noise, apart.kind)
        level = float(apart.position(total.time[0]))
    if abs(level - height) > SUM_OF_HEIGHTS:
        remarks.append(f"with the car's height it adds up to {level:.4g} m at the start; the shaft's height is {height:g} m")
    return replace(counterweight, remarks=tuple(f"{signal.column}: {one}" for one in remarks))


def _constant(signal: Signal) -> float | None:
    """The level [m] of a signal that is constant within its noise, failures of the sensor aside; None for others."""
    good = signal.of(~spikes(signal))
    level = float(np.median(good.position))
    return level if excess(good, np.full(len(good.time), level)).max() <= 1.0 else None
