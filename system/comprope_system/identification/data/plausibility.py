"""What a run shows about its instruments without a simulation: direction, unit and delay of channels against the motion.

A rope that does not slip turns the sheave with the car's speed over its radius; a sensor sees the rope only below its end.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel

from ...measurements.units import UNITS
from ..settings import PLAUSIBILITY
from .car_direction import agreement, is_other, regression
from .channel_noise import spread_of_steps
from .channel_units import other_units
from .runs import Channel, Run

Floats = NDArray[np.float64]


def remarks_on(run: Run, model: RopeModel, channels: Mapping[str, Channel]) -> list[str]:
    """Sentences about channels that contradict the motion of the car, their own stated noise or the size of an elevator."""
    found = [*_directions(run, model, channels), *other_units(run, channels)]
    for column, channel in channels.items():
        value = run.values[column]
        if np.isfinite(value).sum() >= PLAUSIBILITY.min_samples and np.nanmin(value) < np.nanmax(value):
            if channel.quantity == "sheave_angular_velocity":
                found += _angular_velocity(run, model, channel, value)
            found += _size(run, model, channel, value)
            found += _noise(run, channel, value)
    return found


def successions(runs: Sequence[Run]) -> dict[str, list[str]]:
    """Sentences by file about runs that begin elsewhere than the run before ended, by the dates of their files."""
    dated = sorted((run for run in runs if run.started is not None), key=lambda run: float(run.started or 0.0))
    found = {}
    for before, run in pairwise(dated):
        apart = float(run.started or 0.0) - float(before.started or 0.0)
        begin, end = float(run.trip.position(run.time[0])), float(before.trip.position(before.time[-1]))
        if apart < PLAUSIBILITY.succession and abs(begin - end) > PLAUSIBILITY.elsewhere:
            found[run.file] = [
                f"begins at {begin:.4g} m, but the run before it, {before.file}, ended at {end:.4g} m: does the position of the "
                "car count from the start of each run (car_start), or was a run left out?"
            ]
    return found


def common_start(runs: Sequence[Run]) -> dict[str, list[str]]:
    """Sentences by file about runs that all begin at the bottom landing and end at different heights.

    Their positions probably count from the start of each run, unless all trips begin there.
    """
    begins = [float(run.trip.position(run.time[0])) for run in runs]
    ends = [float(run.trip.position(run.time[-1])) for run in runs]
    if len(runs) < PLAUSIBILITY.fewest_runs or np.ptp(ends) < PLAUSIBILITY.elsewhere:
        return {}
    if max(map(abs, begins)) > PLAUSIBILITY.same_start:
        return {}
    advice = "if car_position counts from the start of each run, write car_start"
    return {run.file: [f"begins at the bottom landing, as every run does: {advice}"] for run in runs}


def remarks_on_record(run: Run) -> Iterator[str]:
    """Sentences about gaps of the record and its rests, each with the file of the run."""
    steps = np.diff(run.time)
    widest = int(np.argmax(steps))
    if steps[widest] > max(10.0 * float(np.median(steps)), 0.2):
        yield f"{run.file}: no samples of any channel for {steps[widest]:.2g} s after time = {run.time[widest]:.4g} s"
    if run.trip.kind == "rest":
        yield f"{run.file}: the car does not move"
    elif run.time[-1] < run.trip.rest_after:
        yield f"{run.file}: the record ends before the car stops"
    rest = run.trip.rest_before - run.time[0]  # negative after a run-up, which the recovery of the motion tells
    if run.trip.kind != "rest" and 0.0 <= rest < 0.5:
        yield f"{run.file}: only {rest:.2f} s at rest before the trip: the reference values at rest are uncertain"
    if run.trip.noise > 5e-3:
        yield f"{run.file}: car_position deviates from a smooth trip by {1e3 * run.trip.noise:.1f} mm (standard deviation)"
    if run.trip.kind == "spline":
        yield f"{run.file}: the car follows no jerk-limited profile; a smoothing spline is used, with less accurate accelerations"


# -- the sheave's rotation ---------------------------------------------------------------------------


def rolling_speed(run: Run, model: RopeModel, time: Floats) -> Floats:
    """Angular velocity (n,) [rad/s] of a sheave on which the rope does not slip, at `time` (n,) [s]; positive upward."""
    return np.asarray(run.trip.velocity(time) / model.sheave.radius)


def _angular_velocity(run: Run, model: RopeModel, channel: Channel, value: Floats) -> Iterator[str]:
    """Sign, unit and delay of the sheave's measured angular velocity."""
    rolling = rolling_speed(run, model, run.time)
    gain, correlation = regression(value, rolling)
    name = channel.column
    if not np.isfinite(gain):
        return
    if abs(correlation) < PLAUSIBILITY.swapped and (other := _follower(run, model, name)):
        yield f"{name} does not follow the car's speed, but {other} does: the two are probably swapped"
        return
    if abs(correlation) < PLAUSIBILITY.min_correlation:
        yield f"{name} does not follow the car's speed: wrong column, or not the angular velocity of the sheave"
        return
    if correlation < 0.0:
        yield (
            f"{name}: negative while the car goes up: write sign = -1 for this channel; or, if car_position counts downward, "
            "sign = -1 and zero = ... under [car]"
        )
    size = abs(gain)
    if not 1.0 / PLAUSIBILITY.gain < size < PLAUSIBILITY.gain:
        units = UNITS[channel.quantity]
        fitting = [one for one, scale in units.items() if 0.9 < size * scale / channel.scale < 1.1]
        advice = f'its unit is probably "{fitting[0]}"' if fitting else "check its unit and scale, and sheave.radius"
        yield f"{name}: {size:.3g} times the angular velocity of a sheave on which the rope does not slip; {advice}"
    yield from _at_rest(run, channel, value)
    late = _delay(run, model, np.sign(gain) * value / size)
    if abs(late) > PLAUSIBILITY.delay:
        word = "later" if late > 0.0 else "earlier"
        yield f"{name}: {abs(late):.2g} s {word} than the car's motion: check the clocks, or write offsets in the run"


def _at_rest(run: Run, channel: Channel, value: Floats) -> Iterator[str]:
    """An angular velocity that is not zero while the car rests."""
    rest = value[run.rest & np.isfinite(value)]
    if channel.reference != "absolute" or len(rest) < PLAUSIBILITY.min_samples:
        return
    level = float(np.median(rest))
    if abs(level) > max(PLAUSIBILITY.turning_at_rest * float(np.nanmax(np.abs(value))), 3.0 * spread_of_steps(rest)):
        shown = f"{level / channel.scale:.3g} {channel.unit}"
        yield f"{channel.column}: {shown} while the car rests: write its reading at rest as zero, or reference = \"rest\""


def _follower(run: Run, model: RopeModel, name: str) -> str | None:
    """Another channel that follows the car's speed in place of this one."""
    rolling = rolling_speed(run, model, run.time)
    others = (column for column in run.values if column != name)
    return next((one for one in others if abs(regression(run.values[one], rolling)[1]) > PLAUSIBILITY.swapped), None)


def _delay(run: Run, model: RopeModel, value: Floats) -> float:
    """The delay [s] at which a channel is closest to the rolling speed."""
    known = np.flatnonzero(np.isfinite(value))
    known = known[:: max(len(known) // PLAUSIBILITY.delay_samples, 1)]
    delays = np.arange(-PLAUSIBILITY.max_delay, PLAUSIBILITY.max_delay + 1e-9, PLAUSIBILITY.delay_step)
    misfit = [float(np.mean((value[known] - rolling_speed(run, model, run.time[known] - late)) ** 2)) for late in delays]
    return float(delays[int(np.argmin(misfit))])


# -- what a sensor can see ---------------------------------------------------------------------------


def _directions(run: Run, model: RopeModel, channels: Mapping[str, Channel]) -> Iterator[str]:
    """Sensors that see the rope where another one would, or one on the other side."""
    for column, channel in channels.items():
        if channel.quantity == "lateral_displacement":
            found = agreement(model, channel, run.values[column], (run.trip, run.counterweight), run.time)
            likely = max(found.others, key=lambda name: found.others[name]) if found else ""
            if found and is_other(found.described, found.others[likely]):
                yield (
                    f"{column}: does not see the rope where sensor {channel.sensor} would, but where sensor {likely} would: "
                    "swapped channels, or a wrong side or height in the model"
                )


# -- sizes -------------------------------------------------------------------------------------------


def _size(run: Run, model: RopeModel, channel: Channel, value: Floats) -> Iterator[str]:
    """Displacements larger than an elevator allows, and tensions that one rope does not have."""
    unit, scale = channel.unit, channel.scale
    if channel.quantity.endswith("displacement"):
        limit = PLAUSIBILITY.lateral if channel.quantity == "lateral_displacement" else max(model.shaft.pit, PLAUSIBILITY.axle)
        reach = float(np.nanpercentile(np.abs(value - np.nanmedian(value)), 99.0))
        if reach > limit:
            far = f"{reach / scale:.3g} {unit} from its median, more than {limit / scale:g} {unit}"
            yield f"{channel.column}: {far}: check its unit"
    if channel.quantity.endswith("tension") and channel.reference == "absolute" and run.rest.any():
        end = run.trip if channel.quantity.startswith("car") else run.counterweight
        length = model.shaft.pit + float(end.position(run.time[:1])[0])
        expected = model.shaft.gravity * (0.5 * model.sheave.mass_per_rope + model.rope.mass_per_length * length)
        ratio = float(np.nanmedian(value[run.rest])) / expected
        if not 1.0 / PLAUSIBILITY.tension < ratio < PLAUSIBILITY.tension:
            yield (
                f"{channel.column}: {ratio:.3g} times the weight that one rope carries at rest, {expected / scale:.4g} {unit}: "
                "check its unit; tensions are one rope's, and so are sheave.mass and sheave.inertia unless sheave.ropes is set"
            )


def _noise(run: Run, channel: Channel, value: Floats) -> Iterator[str]:
    """A noise at rest that is a power of ten off the stated one, which is a wrong unit rather than another noise."""
    rest = value[run.rest & np.isfinite(value)]
    if not channel.noise or len(rest) < PLAUSIBILITY.min_samples:
        return
    ratio = spread_of_steps(rest) / (channel.noise * channel.scale)
    if ratio > 0.0 and not 1.0 / PLAUSIBILITY.noise < ratio < PLAUSIBILITY.noise:
        seen = ratio * channel.noise
        stated = f"noise = {channel.noise:g} {channel.unit} is stated"
        yield f"{channel.column}: {stated}, but at rest its standard deviation is {seen:.2g} {channel.unit}: check its unit"
