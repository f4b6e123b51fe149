"""Whether a position, speed or acceleration can be that of a car: its place in the shaft, its speed, its resolution."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from comprope.errors import InputError

from ..columns.car_units import ACCELERATIONS, SHORTEST, SPEEDS, Course, course, fastest, fits_shaft, time_unit
from ..motion.signal.noise import resolution
from ..units import TIMES
from .run_files import RunFiles, Samples

Floats = NDArray[np.float64]

SLOWEST_SAMPLING = 1.0  # s between samples of a record whose unit of time is to be believed without the car's motion
COARSE = 5e-3  # m; steps of a position from which on they are worth a remark


def checked_time(files: RunFiles, samples: Samples, value: Floats, quantity: str, height: float) -> Floats:
    """The times in the unit with which the motion is a car's, where no file states that unit."""
    found = _course(samples.time, value, quantity)
    step = float(np.median(np.diff(samples.time)))
    if found is None:
        if step >= SLOWEST_SAMPLING:
            raise InputError(f"time: samples are {step:g} s apart: in which unit is it? Write time_unit under [file]")
        return samples.time
    if found.fits(height):
        return samples.time
    would = f"move at {found.speed:.3g} m/s" if found.measured == "position" else f"travel {found.travel:.4g} m"
    unit = time_unit(found, height)
    if unit is not None:
        files.assume_time_unit(unit, f"in seconds the car would {would}")
        return samples.time * TIMES[unit]
    if found.measured == "position" and found.speed < SPEEDS[0] and step < SLOWEST_SAMPLING:
        return samples.time
    accepted = f"{SPEEDS[0]:g} to {fastest(found.travel):.3g} m/s is accepted over {found.travel:.3g} m"
    if found.measured == "speed":
        accepted = f"up to {height:g} m, the height of the shaft, is accepted"
    raise InputError(
        f"the car would {would}; {accepted}: check the unit of the car, and write time_unit under [file], or, if time counts "
        "samples or ticks, their rate"
    )


def _course(time: Floats, value: Floats, quantity: str) -> Course | None:
    """The first travel of the car from its position or its speed; None of an acceleration."""
    if quantity == "position":
        return course(time, value)
    if quantity != "speed":
        return None
    known = np.isfinite(value)
    found = course(time[known], cumulative_trapezoid(value[known], time[known], initial=0.0))
    return found and replace(found, measured="speed")


def require_in_shaft(value: Floats, name: str, height: float, key: str, start: float | None) -> None:
    """Raise `InputError` for positions [m] outside of a shaft of this height [m], with what to write under [`key`]."""
    if fits_shaft(value, height):
        return
    low, high = np.nanpercentile(value, (1.0, 99.0))
    reach = f"{name} lies from {low:.5g} to {high:.5g} m, outside of the shaft (0 to {height:g} m)"
    if start is None and high - low <= height + 1.0:
        first = float(np.nanmedian(value[: max(len(value) // 100, 1)]))
        advice = (
            f"write zero = ... (its reading at the bottom landing) and sign = -1 if it counts downward under [{key}], "
            f"or, if it counts from {first:.3g} m at the start of each run, car_start = ... in the run"
        )
    else:
        advice = f"check unit, scale, sign and zero under [{key}], and shaft.height of the model"
    raise InputError(f"{reach}: {advice}")


def implausible(time: Floats, value: Floats, name: str, sure: bool) -> Iterator[str]:
    """Sentences about a motion whose size, resolution or, where the unit of time is stated, speed is hardly a car's."""
    low, high = np.nanpercentile(value, (1.0, 99.0))
    found = course(time, value)
    if high - low < SHORTEST:
        yield f"{name}: moves by {1e3 * (high - low):.3g} mm in all: check its unit"
    elif sure and found is not None and not SPEEDS[0] <= found.speed <= fastest(found.travel):
        usual = f"{SPEEDS[0]:g} to {fastest(found.travel):.3g} m/s is usual over {found.travel:.3g} m"
        yield f"{name}: moves at {found.speed:.3g} m/s; {usual}: check the units of time and position"
    elif found is not None and found.acceleration < ACCELERATIONS[0]:
        takes = found.speed / found.acceleration
        yield f"{name}: takes some {takes:.2g} s to reach {found.speed:.3g} m/s and to stop: check the units of time and position"
    if (step := resolution(value[np.isfinite(value)])) >= COARSE:
        yield f"{name}: changes in steps of {1e3 * step:.2g} mm, by which the motion may be uncertain"
