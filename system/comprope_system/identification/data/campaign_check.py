"""Problems and remarks of each run of a campaign, without a simulation."""

from dataclasses import dataclass, replace
from pathlib import Path

from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import load, with_changes

from ...measurements.campaign_file import CampaignFile, RunSpec, read_campaign_file
from ...presets.inputs import require_still_building
from .campaign import campaign_path, channel_problems, read_run
from .plausibility import common_start, remarks_on, remarks_on_record, successions
from .runs import Run


@dataclass(frozen=True)
class RunCheck:
    """What was found in one run: `problems`, with which the campaign is not read, and `remarks`, about which it is read."""

    file: str
    problems: tuple[str, ...]
    remarks: tuple[str, ...]
    run: Run | None = None


@dataclass(frozen=True)
class CampaignCheck:
    """What was found in a campaign: `problems` of campaign.toml and the model file, and each run."""

    name: str
    folder: Path
    problems: tuple[str, ...]
    runs: tuple[RunCheck, ...]


def check_campaign(folder: str | Path) -> CampaignCheck:
    """Read and check all files of a campaign; raises `InputError` if campaign.toml is missing or cannot be understood."""
    path = campaign_path(folder)
    described = read_campaign_file(path)
    problems: list[str] = []
    try:
        model = require_still_building(load(path.parent / described.model), "a campaign")
    except InputError as error:
        return CampaignCheck(described.name, path.parent, tuple(str(error).splitlines()), ())
    problems += channel_problems(path, described, model)
    if problems:
        return CampaignCheck(described.name, path.parent, tuple(problems), ())
    runs = _with_successions([_run(path, spec, described, model) for spec in described.runs])
    if not any(one.role == "fit" for one in described.runs):
        problems.append(f'{path}: runs: at least one with role = "fit" is needed')
    return CampaignCheck(described.name, path.parent, tuple(problems), runs)


def _with_successions(checks: list[RunCheck]) -> tuple[RunCheck, ...]:
    """The runs with a remark on each that begins elsewhere than the one before ended, by dates, or where all others begin."""
    runs = [one.run for one in checks if one.run is not None]
    said = successions(runs)
    for file, sentences in common_start(runs).items():
        said[file] = [*said.get(file, ()), *sentences]
    return tuple(replace(one, remarks=(*one.remarks, *said.get(one.file, ()))) for one in checks)


def _run(path: Path, spec: RunSpec, described: CampaignFile, model: RopeModel) -> RunCheck:
    try:
        run = read_run(path, spec, described, model)
    except InputError as error:
        return RunCheck(spec.file, tuple(str(error).splitlines()), ())
    changed = with_changes(model, spec.set, f"{path}: {spec.file}")
    channels = {one.column: one for one in described.channels}
    notes = [note.removeprefix(f"{spec.file}: ") for note in run.notes]
    record = [one.removeprefix(f"{spec.file}: ") for one in remarks_on_record(run)]
    return RunCheck(spec.file, (), (*notes, *record, *remarks_on(run, changed, channels)), run)


