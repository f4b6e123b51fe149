"""Whether a position, speed or acceleration can be that of a car: its place in the shaft, its speed, its resolution."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from comprope.errors import InputError

from ..columns.car_units import SHORTEST, SPEEDS, fastest, fits_shaft, middle_speed, time_unit
from ..motion.signal.noise import resolution
from ..units import TIMES
from .run_files import RunFiles, Samples

Floats = NDArray[np.float64]

SLOWEST_SAMPLING = 1.0  # s between samples of a record whose unit of time is to be believed without the car's motion
COARSE = 5e-3  # m; steps of a position from which on they are worth a remark


def checked_time(files: RunFiles, samples: Samples, value: Floats, quantity: str, height: float) -> Floats:
    """The times in the unit with which the motion is a car's, where no file states that unit."""
    found = middle_speed(samples.time, value) if quantity == "position" else _speed_of(samples, value, quantity, height)
    step = float(np.median(np.diff(samples.time)))
    if found is None:
        if step >= SLOWEST_SAMPLING:
            raise InputError(f"time: samples are {step:g} s apart: in which unit is it? Write time_unit under [file]")
        return samples.time
    speed, travel = found
    if SPEEDS[0] <= speed <= fastest(travel):
        return samples.time
    unit = time_unit(speed, travel)
    if unit is not None:
        files.assume_time_unit(unit, f"in seconds the car would move at {speed:.3g} m/s")
        return samples.time * TIMES[unit]
    if speed < SPEEDS[0] and step < SLOWEST_SAMPLING:
        return samples.time
    raise InputError(
        f"the car would move at {speed:.3g} m/s; {SPEEDS[0]:g} to {fastest(travel):.3g} m/s is accepted over {travel:.3g} m: "
        "check the unit of the car, and "
        "write time_unit under [file], or, if time counts samples, their rate"
    )


def _speed_of(samples: Samples, value: Floats, quantity: str, height: float) -> tuple[float, float] | None:
    """Speed and travel for `time_unit` from a measured speed, whose travel is too long by as much as the unit of time."""
    if quantity != "speed":
        return None
    known = np.isfinite(value)
    travel = float(trapezoid(np.abs(value[known]), samples.time[known]))
    top = float(np.percentile(np.abs(value[known]), 99.0))
    return (top, travel) if travel <= height + 1.0 else (top * height / travel, height)


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
    if high - low < SHORTEST:
        yield f"{name}: moves by {1e3 * (high - low):.3g} mm in all: check its unit"
    elif sure and (found := middle_speed(time, value)) is not None and not SPEEDS[0] <= found[0] <= fastest(found[1]):
        usual = f"{SPEEDS[0]:g} to {fastest(found[1]):.3g} m/s is usual over {found[1]:.3g} m"
        yield f"{name}: moves at {found[0]:.3g} m/s; {usual}: check the units of time and position"
    if (step := resolution(value[np.isfinite(value)])) >= COARSE:
        yield f"{name}: changes in steps of {1e3 * step:.2g} mm, by which the motion may be uncertain"
