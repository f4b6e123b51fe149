"""TDMS files of LabVIEW."""

from pathlib import Path

import pandas as pd
from nptdms import TdmsFile

from comprope.errors import InputError

from ..file_format import FileFormat
from ..raw_table import RawColumn, RawTable, unique_names


def read(path: Path, stated: FileFormat) -> RawTable:
    """The channels of all groups, or of the stated one; a waveform's time is its own clock."""
    file = TdmsFile.read(path)
    groups = [group.name for group in file.groups()]
    if stated.sheet is not None and stated.sheet not in groups:
        raise InputError(f'file.sheet = "{stated.sheet}": a group of the file is accepted: {", ".join(groups)}')
    channels = [
        channel for group in file.groups() if stated.sheet in (None, group.name) for channel in group.channels() if len(channel)
    ]
    starts = [one.properties["wf_start_time"] for one in channels if "wf_start_time" in one.properties]
    bare = [channel.name for channel in channels]
    names = unique_names([one.name if bare.count(one.name) == 1 else f"{one.group_name}/{one.name}" for one in channels])
    columns = []
    for name, channel in zip(names, channels, strict=True):
        clock = None
        if "wf_increment" in channel.properties and channel.properties["wf_increment"] > 0.0:
            own = channel.properties.get("wf_start_time")
            late = float((own - min(starts)) / pd.Timedelta(seconds=1).to_timedelta64()) if own is not None else 0.0
            clock = pd.Series(channel.time_track() + late)
        unit = channel.properties.get("unit_string") or channel.properties.get("NI_UnitDescription")
        written = str(unit).strip() or None if unit else None
        columns.append(RawColumn(name, pd.Series(channel[:]), written, clock, channel.group_name))
    return RawTable(tuple(columns))
