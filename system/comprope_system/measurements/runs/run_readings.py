"""What campaign.toml states about one run only: how its columns are read, and names that stand for nothing in it."""

from collections.abc import Collection
from typing import TypeVar

from comprope.validation_messages import suggestion

from ..campaign_file import CampaignFile, Channel, MotionColumn, RunReading, RunSpec
from ..files.raw_table import printable
from ..units import UNITS

MOTIONS = ("car", "counterweight")
Read = TypeVar("Read", Channel, MotionColumn)


def with_readings(described: CampaignFile, spec: RunSpec) -> CampaignFile:
    """The campaign file with the channels and motions as they are read in the run `spec`."""
    changes = {key: _read(getattr(described, key), spec.readings.get(key)) for key in MOTIONS}
    channels = tuple(_read(one, spec.readings.get(one.column)) for one in described.channels)
    return described.model_copy(update={**changes, "channels": channels})


def _read(usual: Read, own: RunReading | None) -> Read:
    return usual if own is None else usual.model_copy(update={key: getattr(own, key) for key in own.model_fields_set})


def run_problems(described: CampaignFile) -> list[str]:
    """Sentences about channels and files that runs name and that there are not, and about units that are none of a quantity.

    Such a name would otherwise be passed over, and the channel be read from another column, file or clock.
    """
    return [f"runs[{k}].{line}" for k, spec in enumerate(described.runs, 1) for line in _problems(spec, described)]


def _problems(spec: RunSpec, described: CampaignFile) -> list[str]:
    channels = {one.column: one for one in described.channels}
    keys = (*channels, *MOTIONS)
    named: tuple[tuple[str, Collection[str], Collection[str]], ...] = (
        ("files", spec.files, keys), ("columns", spec.columns, keys), ("readings", spec.readings, keys),
        ("offsets", spec.offsets, tuple(spec.files.values())),
    )  # fmt: skip
    found = [
        f'{table}."{printable(key)}": no {"other file" if table == "offsets" else "channel"} of the run; {_accepted(key, known)}'
        for table, stated, known in named
        for key in stated
        if key not in known
    ]
    for key, one in spec.readings.items():
        units = UNITS[channels[key].quantity] if key in channels else None
        if units is not None and one.unit is not None and one.unit not in units:
            shown = f'readings."{printable(key)}".unit = "{printable(one.unit)}"'
            found.append(f"{shown}: for {channels[key].quantity} {', '.join(units)} are accepted")
    return found


def _accepted(key: str, known: Collection[str]) -> str:
    return printable(suggestion(key, list(known)), 300)
