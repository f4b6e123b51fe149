"""The table of one measured run in SI units, with time from zero, from whatever files hold it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError

from .campaign_file import CampaignFile, Channel, RunSpec
from .columns.column_names import find_column
from .columns.readings import is_constant
from .files.file_format import FileFormat
from .motion_column import MotionSignal, read_motion
from .recover import recover_trip
from .run_files import RunFiles
from .trip import Trip
from .units import UNITS

Floats = NDArray[np.float64]
T = TypeVar("T")
__all__ = ["UNITS", "RunTable", "present_channels", "read_run_table", "read_trips"]


@dataclass(frozen=True)
class RunTable:
    """One run: `values[column]` (n,) [SI] at `time` (n,) [s] from zero, NaN where there is no sample.

    `car` and `counterweight` have times of their own; `remarks` are sentences about the data. `sampled[column]` (n,) are
    the times at which a channel has a row at all, for channels with a clock of their own.
    """

    time: Floats
    car: MotionSignal
    counterweight: MotionSignal | None
    values: dict[str, Floats]
    remarks: tuple[str, ...] = ()
    sampled: dict[str, NDArray[np.bool_]] = field(default_factory=dict)

    @property
    def car_position(self) -> Floats:
        """Readings of the car (n,) [SI] at `time`, between its own samples by interpolation."""
        if np.array_equal(self.car.time, self.time):
            return self.car.value
        known = np.isfinite(self.car.value)
        return np.interp(self.time, self.car.time[known], self.car.value[known])


def read_run_table(folder: Path, spec: RunSpec, described: CampaignFile, height: float, within: Path | None) -> RunTable:
    """The run `spec` of a campaign in `folder`, in a shaft of this height [m]; `within`: its files must lie in that folder.

    Raises `InputError` with one line for each problem of the run's files.
    """
    files = RunFiles(folder, spec, described.file, within)
    problems: list[str] = []
    remarks: list[str] = []
    car = _collect(problems, lambda: read_motion(files, described.car, "car", height, spec.car_start))
    counterweight = _collect(problems, lambda: read_motion(files, described.counterweight, "counterweight", height, None))
    read: dict[str, tuple[Floats, Floats]] = {}
    for k, channel in enumerate(described.channels, 1):
        if channel.unit in UNITS[channel.quantity]:
            own = _collect(problems, partial(_channel, files, channel, k, remarks))
            if own is not None:
                read[channel.column] = own
    if problems or car is None:
        raise InputError("\n".join(dict.fromkeys(problems)))
    car, counterweight, read = _from_zero(car, counterweight, read)
    time, values, sampled = _on_one_axis(car, read)
    signals = [one for one in (car, counterweight) if one is not None]
    said = [*files.remarks, *(remark for one in signals for remark in one.remarks), *remarks]
    return RunTable(time, car, counterweight, values, tuple(dict.fromkeys(said)), sampled)


def present_channels(folder: Path, spec: RunSpec, stated: FileFormat, channels: Sequence[Channel]) -> tuple[Channel, ...]:
    """Those of the channels whose columns the files of a run have, with units that are accepted."""
    files = RunFiles(folder, spec, stated, None)
    found = []
    for channel in channels:
        try:
            find_column(files.table(files.file_of(channel.column)), spec.columns.get(channel.column, channel.column))
        except InputError:
            continue
        found.append(channel)
    return tuple(found)


def _collect(problems: list[str], make: Callable[[], T]) -> T | None:
    """Result of `make`; None if it raises `InputError`, whose lines are appended to `problems`."""
    try:
        return make()
    except InputError as error:
        problems += str(error).splitlines()
        return None


def _channel(files: RunFiles, channel: Channel, number: int, remarks: list[str]) -> tuple[Floats, Floats]:
    """Times [s] and values [SI] (n,) of a channel; with a remark if it is empty or shows one value only."""
    found = files.channel(channel, f"channels[{number}]")
    remarks += found.remarks
    readings = found.values
    if (channel.sign, channel.factor, channel.zero) != (1, 1.0, 0.0):
        readings = channel.sign * channel.factor * (readings - channel.zero)
    values = readings * channel.scale
    if not np.isfinite(values).any():
        remarks.append(f"{channel.column}: no values in this run; left out of it")
    elif is_constant(values):
        value = float(found.values[np.isfinite(found.values)][0])
        remarks.append(f"{channel.column}: flat, {value:g} in every sample: not used in fits, and its error is not defined")
    return found.time, values


def _from_zero(
    car: MotionSignal, counterweight: MotionSignal | None, read: dict[str, tuple[Floats, Floats]]
) -> tuple[MotionSignal, MotionSignal | None, dict[str, tuple[Floats, Floats]]]:
    """The same with times from the first sample of all."""
    first = float(min([car.time[0], *(time[0] for time, _ in read.values())]))
    if first == 0.0:
        return car, counterweight, read
    moved = {column: (time - first, values) for column, (time, values) in read.items()}
    other = counterweight and replace(counterweight, time=counterweight.time - first)
    return replace(car, time=car.time - first), other, moved


def _on_one_axis(
    car: MotionSignal, read: dict[str, tuple[Floats, Floats]]
) -> tuple[Floats, dict[str, Floats], dict[str, NDArray[np.bool_]]]:
    """The clock of the channels if they share one, otherwise the times of all, with NaN between a channel's own samples."""
    if not read:
        return car.time, {}, {}
    clocks = [time for time, _ in read.values()]
    if all(np.array_equal(one, clocks[0]) for one in clocks[1:]):
        return clocks[0], {column: values for column, (_, values) in read.items()}, {}
    union = np.unique(np.concatenate(clocks))
    values, sampled = {}, {}
    for column, (time, own) in read.items():
        at = np.searchsorted(union, time)
        values[column] = np.full(len(union), np.nan)
        values[column][at] = own
        sampled[column] = np.zeros(len(union), bool)
        sampled[column][at] = True
    return union, values, sampled


def read_trips(car: MotionSignal, counterweight: MotionSignal | None, height: float, file: str) -> tuple[Trip, Trip]:
    """The smooth trips of car and counterweight estimated from their signals, for a shaft height [m].

    Raises `InputError`, which names the `file`, for a motion that cannot be recovered.
    """
    try:
        trip = recover_trip(car.time, car.value)
        return trip, trip.mirrored(height) if counterweight is None else recover_trip(counterweight.time, counterweight.value)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
