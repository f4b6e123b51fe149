"""Which files belong to one run: as stated, or those without the car's motion by date and time or by their names."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from comprope.errors import InputError

from ...measurements.campaign_file import Reading, RunSpec
from ...measurements.columns.column_names import COUNTERWEIGHT_NAMES, car_column, is_time_name
from ...measurements.columns.signal_faults import CHANNEL_RULES
from ...measurements.files.file_format import FileFormat
from ...measurements.files.raw_table import printable
from ...measurements.runs.run_files import RunFiles
from ..column_roles import GUESS, LIKELY, SURE


@dataclass(frozen=True)
class RunGroup:
    """The files of one run: the one with the car's motion, and others with how surely and why they belong to it."""

    file: str
    others: Mapping[str, str] = field(default_factory=dict)


def grouped(folder: Path, stated: Sequence[Sequence[str]]) -> list[RunGroup]:
    """The runs of files in `folder`; files that are stated together are one run.

    A file without a column that is named as the motion of car or counterweight is part of the run it belongs to, if others have
    one. Raises `InputError` for a file that may belong to several runs.
    """
    moving = {file: _has_motion(folder, file) for files in stated for file in files}
    groups = []
    for files in stated:
        main = next((one for one in files if moving[one]), files[0])
        if len(files) > 1 or moving[main] or not any(moving.values()):
            groups.append(RunGroup(main, {one: f"{SURE}: as stated" for one in files if one != main}))
    mains = [one.file for one in groups]
    spans = {file: _dates(folder, file) for file in moving} if len(mains) < len(stated) else {}
    found: dict[str, dict[str, str]] = {one.file: dict(one.others) for one in groups}
    for files in stated:
        if len(files) == 1 and files[0] not in found:
            main, why = _main_of(files[0], mains, spans)
            found[main][files[0]] = why
    return [RunGroup(one.file, found[one.file]) for one in groups]


def _main_of(file: str, mains: Sequence[str], spans: Mapping[str, tuple[float, float] | None]) -> tuple[str, str]:
    """The run to which a file belongs, and how surely and why."""
    own = spans[file]
    if own is not None:
        dated = [one for one in mains if (other := spans[one]) is not None and other[0] < own[1] and own[0] < other[1]]
        if len(dated) == 1:
            return dated[0], f"{LIKELY}: by date and time"
    shared = {one: len(set(words(file)) & set(words(one))) for one in mains}
    most = max(shared.values())
    named = [one for one, count in shared.items() if count == most and count > 0]
    if len(named) == 1 and len(mains) > 1:
        return named[0], f"{LIKELY}: by its name"
    if len(mains) == 1:
        return mains[0], f"{LIKELY}: by its name" if named else f"{GUESS}: the only run"
    shown = printable(", ".join(mains), 200)
    raise InputError(
        f"{printable(file)}: holds no motion of the car, and to which run does it belong? Write RUN+{printable(file)} "
        f"with one of {shown}, or rename its column car_position"
    )


def words(file: str) -> list[str]:
    """Words and numbers of a file's name."""
    return re.findall(r"[^\W\d_]+|\d+", Path(file).stem.lower())


def _has_motion(folder: Path, file: str) -> bool:
    """Whether a column is named as the motion of car or counterweight; true for unreadable files, which are told later."""
    try:
        table = RunFiles(folder, RunSpec(file=file), FileFormat(), folder).table(file)
        return car_column(table) is not None or car_column(table, COUNTERWEIGHT_NAMES) is not None
    except InputError:
        return True


def _dates(folder: Path, file: str) -> tuple[float, float] | None:
    """First and last date and time [s] of a file; None where it has none."""
    files = RunFiles(folder, RunSpec(file=file), FileFormat(), folder)
    for column in files.table(file).columns:
        if not is_time_name(column.name):
            try:
                time = files.samples(column, file, Reading(), CHANNEL_RULES).time
            except InputError:
                continue
            return None if files.started is None else (files.started, files.started + float(time[-1] - time[0]))
    return None
