"""The files of one run: columns by channel, each with its times on the clock of the run."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError

from ..campaign_file import Channel, Reading, RunSpec
from ..columns.clock_columns import clock_columns, clock_of, unnamed_clocks
from ..columns.column_names import find_column
from ..columns.long_table import widened
from ..columns.readings import Rules, numbers_of, unit_problem
from ..columns.row_order import in_order
from ..columns.signal_faults import CHANNEL_RULES
from ..columns.split_clock import with_joined_clock
from ..columns.time_axis import first_column_times, time_axis
from ..columns.times import TimeAxis, row_times
from ..files.file_format import FileFormat
from ..files.raw_table import RawColumn, RawTable, printable
from ..files.reader import read_raw_table
from ..units import UNITS

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Samples:
    """Readings (n,) of a column at times (n,) [s] of the run, NaN where there is none; remarks; whether the time unit is sure."""

    time: Floats
    values: Floats
    remarks: tuple[str, ...]
    sure: bool = True


def _present_column(table: RawTable, channel: str, spec: RunSpec) -> RawColumn:
    """The column of a channel; raises `InputError` if there is none, with what to write for a run without it."""
    try:
        return find_column(table, spec.columns.get(channel, channel))
    except InputError as error:
        if channel in spec.columns or "no column" not in str(error):
            raise
        advice = f'if it was not measured in this run, write columns = {{ "{printable(channel)}" = "" }}'
        raise InputError(f"{error}; {advice}") from None


@dataclass
class RunFiles:
    """The files of the run `spec` in `folder`, each read once; with `within`, all must lie in that folder.

    `assumed_unit` is that of numeric times whose unit no file states; `remarks` are about the files and their times.
    """

    folder: Path
    spec: RunSpec
    stated: FileFormat
    within: Path | None
    assumed_unit: str = "s"
    remarks: list[str] = field(default_factory=list)
    _tables: dict[str, RawTable] = field(default_factory=dict)
    _axes: dict[int, TimeAxis] = field(default_factory=dict)
    _start: TimeAxis | None = None

    def table(self, file: str) -> RawTable:
        """The raw table of a file; raises `InputError`, which names it."""
        if file not in self._tables:
            raw = read_raw_table(self.folder / file, self.stated, self.within)
            found = in_order(widened(with_joined_clock(raw)), self.stated)
            self._tables[file] = found
            self._remark(file, *found.remarks)
            for one in unnamed_clocks(found):
                self._remark(
                    file,
                    f"{one.name} counts evenly, as a clock does, but is not named as one; no column is read at its times",
                )
        return self._tables[file]

    def file_of(self, key: str) -> str:
        """The file that holds a channel, "car" or "counterweight"."""
        return self.spec.files.get(key, self.spec.file)

    def channel(self, channel: Channel, where: str) -> Samples:
        """The readings of a channel; `where` names its table in campaign.toml. Raises `InputError`, which names the file."""
        file = self.file_of(channel.column)
        try:
            table = self.table(file)
            column = _present_column(table, channel.column, self.spec)
            if problem := self.unit_problem(column, channel.unit, UNITS[channel.quantity], channel.factor, where):
                raise InputError(problem)
            return self.samples(column, file, channel, CHANNEL_RULES)
        except InputError as error:
            raise self.named(file, error) from None

    def unit_problem(self, column: RawColumn, unit: str, accepted: dict[str, float], factor: float, where: str) -> str | None:
        """A sentence if the file states another unit than campaign.toml, unless units in files are to be ignored."""
        return None if self.stated.ignore_units else unit_problem(column, unit, accepted, factor, where)

    def samples(self, column: RawColumn, file: str, reading: Reading, rules: Rules) -> Samples:
        """The readings of a column at the times of the run, rows without a time left out."""
        table = self.table(file)
        values, remarks = numbers_of(column, table, (*self.stated.missing, *reading.missing), rules)
        axis = self._axis(column, table, reading.time)
        if axis.remark:
            self._remark(file, axis.remark)
        seconds = self._on_clock_of_run(axis, file, column.name)
        timed = np.isfinite(seconds)
        if lost := int((~timed & np.isfinite(values)).sum()):
            remarks = [*remarks, f"{column.name}: {lost} {'sample' if lost == 1 else 'samples'} without a time left out"]
        return Samples(seconds[timed], values[timed], tuple(self._prefixed(file, one) for one in remarks), axis.sure)

    def named(self, file: str, error: InputError) -> InputError:
        """The error with the file's name at the beginning of each line that does not have it."""
        path = printable(self.folder / file, 200)
        lines = str(error).splitlines()
        return InputError("\n".join(line if line.startswith(path) else f"{path}: {line}" for line in lines))

    def _axis(self, column: RawColumn, table: RawTable, stated: str | None) -> TimeAxis:
        """The times of a column's samples, in seconds from the first."""
        if stated is None and column.clock is not None:
            return time_axis(RawColumn(f"times of {column.name}", column.clock, "s"), table, FileFormat())
        name = self.stated.time if stated is None else stated
        clocks = [] if name == "" else clock_columns(table, name)
        left = [one for one in clocks if len(one.values) == len(column.values)]
        if left:
            found = self._time_axis(clock_of(column, left, table), table)
        elif self.stated.rate or (table.rate and name != ""):
            found = row_times(table, len(column.values), self.stated.rate or float(table.rate or 0.0))
        else:
            found = first_column_times(column, table, self.stated)
        return found if found.sure or self.assumed_unit == "s" else found.in_unit(self.assumed_unit)

    def _time_axis(self, column: RawColumn, table: RawTable) -> TimeAxis:
        """The times of a column, found once."""
        if id(column) not in self._axes:
            self._axes[id(column)] = time_axis(column, table, self.stated)
        return self._axes[id(column)]

    def _on_clock_of_run(self, axis: TimeAxis, file: str, name: str) -> Floats:
        """Seconds since the first time of the run's first column, on whose clock those of other columns and files are found."""
        if self._start is None:
            self._start = axis
            return axis.seconds
        offset = self.spec.offsets.get(file, 0.0)
        if axis.kind != self._start.kind and file not in self.spec.offsets:
            kinds = {"relative": "seconds from an unknown start", "clock": "a time of day", "date": "date and time"}
            raise InputError(
                f"{name}: its times are {kinds[axis.kind]}, those of the car {kinds[self._start.kind]}: write the seconds to "
                f'add to them in the run, offsets = {{ "{file}" = ... }}'
            )
        if axis.kind == "relative" and file not in (self.spec.file, *self.spec.offsets):
            shown = f'offsets = {{ "{printable(file)}" = ... }}'
            self._remark(file, f"its times are taken to be those of {printable(self.spec.file)}; otherwise write {shown}")
        late = axis.origin - self._start.origin if axis.kind == self._start.kind else 0.0
        return axis.seconds + (late + offset) if late + offset != 0.0 else axis.seconds

    @property
    def started(self) -> float | None:
        """The date and time of the first sample [s]; None where the file has no date."""
        return self._start.origin if self._start is not None and self._start.kind == "date" else None

    def assume_time_unit(self, unit: str, why: str) -> None:
        """Read numeric times without a stated unit in `unit` from now on, with a remark."""
        self.assumed_unit = unit
        if self._start is not None and not self._start.sure:
            self._start = self._start.in_unit(unit)
        self._remark(self.spec.file, f'time read in {unit}: {why}; write time_unit = "{unit}" under [file] to confirm')

    def _remark(self, file: str, *sentences: str) -> None:
        self.remarks += [shown for one in sentences if (shown := self._prefixed(file, one)) not in self.remarks]

    def _prefixed(self, file: str, sentence: str) -> str:
        return sentence if file == self.spec.file else f"{printable(file)}: {sentence}"
