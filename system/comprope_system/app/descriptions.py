"""The first step: what uploaded files are taken for, with corrections, shown as curves, and the campaign that is made of it."""

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import comprope_system
from comprope.errors import InputError

from ..campaign_setup.column_roles import Role
from ..campaign_setup.corrections import Corrections
from ..identification.data.campaign import Campaign, load_campaign
from ..identification.prediction.replay import relative_to_rest
from ..identification_results.reporting.run_curves import phase_spans
from ..measurements.campaign_file import MotionColumn
from ..report.curves import MODEL, Curve, Curves, Group, Panel
from ..report.page import Section, save_page

PREVIEW = "preview.html"
LEAD = "As the campaign would be read: units and signs applied, relative to rest where the channel is, in the channel's unit."


def describe(uploads: list[Path], staged: Path, name: str, stated: Mapping[str, Any]) -> dict[str, Any]:
    """A campaign of the uploaded files in `staged`, made anew; what each column was taken for, and the page with its curves.

    Raises `InputError` where the files cannot be described.
    """
    folder = staged / name
    shutil.rmtree(staged, ignore_errors=True)
    folder.mkdir(parents=True)
    models = [one for one in uploads if one.suffix == ".toml"]
    if len(models) > 1:
        raise InputError(f"{', '.join(one.name for one in models)}: one model file is accepted")
    model: str | Path | None = models[0] if models else stated.get("model") or None
    runs = [one for one in uploads if one not in models]
    result = comprope_system.new(folder, runs, model=model, corrections=_corrections(stated))
    found = result.to_json() | {"summary": result.headline(), "problems": list(result.check.problems), "preview": False}
    if not result.check.problems:
        campaign = load_campaign(folder)
        save_page(staged / PREVIEW, "Measured channels", LEAD, [Section("runs", "Runs", [measured_curves(campaign)])])
        found |= {"preview": True, "sensors": [one.name for one in campaign.model.sensors]}
        found |= {"sheave": {"mass": campaign.model.sheave.mass, "inertia": campaign.model.sheave.inertia}}
    return found


def _corrections(stated: Mapping[str, Any]) -> Corrections:
    """Corrections as the page sends them; raises `InputError` if they have another form."""
    try:
        columns = {
            name: Role(
                one["quantity"] or None, one.get("unit") or "", one.get("sensor") or None, -1 if one.get("sign") == -1 else 1,
                reference=one.get("reference") or None,
            )
            for name, one in stated.get("columns", {}).items()
        }  # fmt: skip
        changes = {
            file: {key: float(value) for key, value in one.items()} for file, one in stated.get("changes", {}).items() if one
        }
        car = MotionColumn(column=stated.get("car") or None)
        return Corrections(car, columns, dict(stated.get("roles", {})), changes)
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"corrections: {type(error).__name__}: {error}") from None


def save_campaign(staged: Path, name: str, target: Path) -> dict[str, Any]:
    """Copy the described campaign to its folder, completely or not at all; raises `InputError` if one is there already."""
    folder = staged / name
    if not (folder / "campaign.toml").is_file():
        raise InputError("nothing has been described yet: drop the files of a logger first")
    if target.exists() and any(target.iterdir()):
        raise InputError(f"{target}: is not empty and is not replaced; start the app with another folder")
    temporary = target.with_name(f".{target.name}-new")
    shutil.rmtree(temporary, ignore_errors=True)
    try:
        shutil.copytree(folder, temporary)
        if target.exists():
            target.rmdir()
        temporary.rename(target)
    except OSError as error:
        shutil.rmtree(temporary, ignore_errors=True)
        raise InputError(f"{target}: cannot be written: {error.strerror or error}") from None
    return {"campaign": str(target)}


def measured_curves(campaign: Campaign) -> Curves:
    """The channels of each run and the motion of the car."""
    groups = []
    for k, run in enumerate(campaign.runs):
        values = relative_to_rest(run.values, run, campaign.channels)
        car = Panel("car position", "m", run.time, [Curve("measured", MODEL, run.car_position)])
        panels = [
            Panel(
                column, one.unit, run.time, [Curve("measured", MODEL, values[column] / one.scale)], one.quantity.replace("_", " ")
            )
            for column, one in campaign.channels.items()
        ]
        groups.append(Group(run.file, f"{run.file} ({run.role})", [car, *panels], phase_spans(run), k == 0))
    return Curves("measured", groups)
