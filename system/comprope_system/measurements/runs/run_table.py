"""The table of one measured run in SI units, with time from zero, from whatever files hold it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError

from ..campaign_file import CampaignFile, Channel, RunSpec
from ..columns.column_names import find_column
from ..columns.readings import is_constant
from ..columns.signal_jumps import jump_remarks
from ..files.file_format import FileFormat
from ..units import UNITS
from .common_clock import on_one_axis
from .lateral_columns import idle_columns, read_lateral
from .motion_column import MotionSignal, mirrored, read_motion
from .run_files import RunFiles
from .run_readings import with_readings

Floats = NDArray[np.float64]
T = TypeVar("T")
ABSENT = ""  # the name of a channel in a run that does not have it
OVERLAP = 0.5  # share of the record of the car during which channels are recorded as well


@dataclass(frozen=True)
class RunTable:
    """One run: `values[column]` (n,) [SI] at `time` (n,) [s] from zero, NaN where there is no sample.

    `car`, `counterweight` and `lateral` (outward displacements of the rope's ends, by end) have times of their own; without a
    column of the car, `car` is the counterweight's mirrored. `remarks` are sentences about the data. `sampled[column]` (n,) are
    the times at which a channel has a row at all, for channels with a clock of their own. `started` is the date and time of
    the first sample [s], None where the files have none.
    """

    time: Floats
    car: MotionSignal
    counterweight: MotionSignal | None
    values: dict[str, Floats]
    remarks: tuple[str, ...] = ()
    sampled: dict[str, NDArray[np.bool_]] = field(default_factory=dict)
    lateral: dict[str, MotionSignal] = field(default_factory=dict)
    started: float | None = None


def read_run_table(folder: Path, spec: RunSpec, described: CampaignFile, height: float, within: Path | None) -> RunTable:
    """The run `spec` of a campaign in `folder`, in a shaft of this height [m]; `within`: its files must lie in that folder.

    Raises `InputError` with one line for each problem of the run's files.
    """
    files = RunFiles(folder, spec, described.file, within)
    problems: list[str] = []
    described = with_readings(described, spec)
    remarks: list[str] = []
    car = _collect(problems, lambda: read_motion(files, described.car, "car", height, spec.car_start))
    counterweight = _collect(problems, lambda: read_motion(files, described.counterweight, "counterweight", height, None))
    read: dict[str, tuple[Floats, Floats]] = {}
    absent = [one.column for one in described.channels if spec.columns.get(one.column) == ABSENT]
    for k, channel in enumerate(described.channels, 1):
        if channel.unit in UNITS[channel.quantity] and channel.column not in absent:
            own = _collect(problems, partial(_channel, files, channel, k, remarks))
            if own is not None:
                read[channel.column] = own
    lateral = _collect(problems, lambda: read_lateral(files, described))
    if problems or lateral is None:
        raise InputError("\n".join(dict.fromkeys(problems)))
    car, counterweight = _acting(car, counterweight, height)
    signals = {"car": car, **lateral} | ({} if counterweight is None else {"counterweight": counterweight})
    remarks += _elsewhere_in_time(car.time, read)
    remarks += [f"{column}: not measured in this run" for column in absent]
    said = [*files.remarks, *(remark for one in signals.values() for remark in one.remarks), *remarks]
    said += idle_columns(files, described, [one.column for one in signals.values()])
    table = _from_zero(RunTable(car.time, car, counterweight, {}, tuple(dict.fromkeys(said)), {}, lateral, files.started), read)
    return replace(table, values=table.values | {column: np.full(len(table.time), np.nan) for column in absent})


def _acting(
    car: MotionSignal | None, counterweight: MotionSignal | None, height: float
) -> tuple[MotionSignal, MotionSignal | None]:
    """The signals that determine the motion: a height before what is integrated to one, the car's before the counterweight's."""
    if counterweight is None or (car is not None and counterweight.quantity != "position"):
        return _present(car), None
    if car is None or car.quantity != "position":
        return mirrored(counterweight, height), None
    return car, counterweight


def _present(car: MotionSignal | None) -> MotionSignal:
    if car is None:
        raise InputError("no column of the car's motion, nor of the counterweight's")
    return car


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
    else:
        remarks += [f"{channel.column}: {one}" for one in jump_remarks(found.time, values / channel.scale, channel.unit)]
    return found.time, values


def _elsewhere_in_time(car: Floats, read: Mapping[str, tuple[Floats, Floats]]) -> list[str]:
    """Sentences about channels that were recorded during less than half of the record of the car."""
    found = []
    for column, (time, _) in read.items():
        both = min(float(car[-1]), float(time[-1])) - max(float(car[0]), float(time[0]))
        spans = f"{time[0]:.4g} to {time[-1]:.4g} s, those of the car from {car[0]:.4g} to {car[-1]:.4g} s"
        if both < OVERLAP * float(car[-1] - car[0]):
            found.append(f"{column}: its times reach from {spans}: check the clocks and units of time of the files")
    return found


def _from_zero(table: RunTable, read: dict[str, tuple[Floats, Floats]]) -> RunTable:
    """The table with the channels, given by their times and values, and with times from the first sample of all."""
    first = float(min([table.car.time[0], *(time[0] for time, _ in read.values())]))
    if first != 0.0:
        read = {column: (time - first, values) for column, (time, values) in read.items()}
        table = replace(
            table,
            car=_earlier(table.car, first),
            counterweight=table.counterweight and _earlier(table.counterweight, first),
            lateral={end: _earlier(one, first) for end, one in table.lateral.items()},
        )
    time, values, sampled = on_one_axis(table.car.time, read)
    return replace(table, time=time, values=values, sampled=sampled)


def _earlier(signal: MotionSignal, seconds: float) -> MotionSignal:
    return replace(signal, time=signal.time - seconds)
