"""What campaign.toml states about the channels of each run, and the noise of a channel at rest."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..measurements.columns.column_names import plain_name
from ..measurements.units import UNITS
from .column_matching import own_name, stated_unit
from .column_roles import ANSWERED, STATED, Role
from .survey.surveyed_runs import SurveyedRun

ABSENT = ""  # the name of a channel in a run that does not have it
FEWEST = 20  # samples at rest for an estimate of the noise
MAD_FACTOR = 1.4826  # standard deviation over median absolute deviation of a normal distribution


@dataclass(frozen=True)
class Answers:
    """What was answered about a run: height of the car at its start [m], and changes of the model by key."""

    car_start: float | None = None
    changes: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True)
class RunEntry:
    """The entry of a run: its file and role, names of channels in its files, their files and units, and what was answered."""

    file: str
    role: str
    columns: Mapping[str, str]
    files: Mapping[str, str]
    readings: Mapping[str, Mapping[str, str]]
    answers: Answers


def run_entry(run: SurveyedRun, role_of_run: str, found: Mapping[str, Role], answers: Answers) -> RunEntry:
    """The entry of a run for columns with the roles `found`."""
    columns = {run.motion.end: run.motion.column} if run.motion.told else {}
    files, readings = {}, {}
    for name, role in found.items():
        channel, own = role.same_as or name, own_name(run, name)
        if not (role.quantity or role.same_as):
            continue
        if own is None:
            if not role.same_as:
                columns.setdefault(channel, ABSENT)
            continue
        column, usual = run.columns[own], found[channel]
        if plain_name(column.raw.name) != plain_name(channel):
            columns[channel] = column.raw.name
        if column.file != run.file:
            files[channel] = column.file
        unit = stated_unit(column) or (role.unit if role.same_as else None)
        told = usual.why in (ANSWERED, STATED)  # against such a unit, one of the file is a problem that the check names
        if unit is not None and not told and unit != usual.unit and unit in UNITS[str(usual.quantity)]:
            readings[channel] = {"unit": unit}
    return RunEntry(run.file, role_of_run, columns, files, readings, answers)


def noise(runs: Sequence[SurveyedRun], name: str, role: Role) -> float | None:
    """Standard deviation of a channel's samples at rest, in its unit, median over the runs; None without rests."""
    found = []
    scales = UNITS[str(role.quantity)]
    for run in runs:
        own = own_name(run, name)
        if own is None or not run.columns[own].related:
            continue
        samples = run.columns[own].samples
        rest = samples.values[(samples.time <= run.car.time[0] + run.rest) & np.isfinite(samples.values)]
        if len(rest) >= FEWEST:
            steps = np.diff(rest)
            deviation = MAD_FACTOR * float(np.median(np.abs(steps - np.median(steps)))) / 2.0**0.5
            found.append(deviation * scales.get(stated_unit(run.columns[own]) or "", scales[role.unit]) / scales[role.unit])
    return float(f"{np.median(found):.2g}") if found and np.median(found) > 0.0 else None
