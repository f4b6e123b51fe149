"""Columns for the lateral displacement of the rope's ends, and columns that name a motion and determine nothing."""

from collections.abc import Iterable

from ..campaign_file import CampaignFile, Channel
from ..columns.column_names import CAR_NAMES, COUNTERWEIGHT_NAMES, named_one_of, plain_name
from .motion_column import MotionSignal
from .run_files import RunFiles

ENDS = ("car", "counterweight")
_NAMED = frozenset(name for names in (CAR_NAMES, COUNTERWEIGHT_NAMES) for known in names.values() for name in known.split())


def read_lateral(files: RunFiles, described: CampaignFile) -> dict[str, MotionSignal]:
    """Outward displacements [m] of the rope's ends, from the columns `car_lateral_displacement` and the like, in m or as stated.

    Raises `InputError`, which names the file, for units that are no lengths.
    """
    found = {}
    channels = {plain_name(one.column) for one in described.channels}
    for end in ENDS:
        name = f"{end}_lateral_displacement"
        present = named_one_of(files.table(files.spec.file), [name])
        if present and name not in channels:
            samples = files.channel(Channel(column=name, quantity="lateral_displacement", unit="m"), name)
            found[end] = MotionSignal(samples.time, samples.values, "position", name, samples.remarks)
    return found


def idle_columns(files: RunFiles, described: CampaignFile, used: Iterable[str]) -> list[str]:
    """Sentences about columns of the run's file that name a motion of the rope's ends and are not `used`."""
    acting = ", ".join(used)
    channels = [files.spec.columns.get(one.column, one.column) for one in described.channels]
    known = {plain_name(name) for name in (*used, *channels)}
    names = [one.name for one in files.table(files.spec.file).columns if plain_name(one.name) not in known]
    return [f"{name}: not used; {acting} determines the motion" for name in names if _speaks_of_motion(plain_name(name))]


def _speaks_of_motion(name: str) -> bool:
    lateral = "lateral" in name and name.split("_")[0] in ("car", "cabin", "counterweight", "cw", "cwt")
    return lateral or name in _NAMED
