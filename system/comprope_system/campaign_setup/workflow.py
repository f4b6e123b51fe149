"""The public function `comprope_system.new`."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from comprope.atomic_files import atomic_write
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import dump, load

from ..identification.workflow import check
from ..measurements.campaign_file import MotionColumn
from ..measurements.files.raw_table import printable
from ..measurements.files.reader import require_regular_file
from ..presets import model_path
from .campaign_text import campaign_text
from .column_matching import renamed, roles
from .questions import Ask, asked_changes, asked_role, without_guess
from .result import NewCampaign
from .survey import SurveyedRun, noise, survey

DEFAULT_MODEL = "tower50"
HELD_OUT = 2  # runs from which on one is held out
SHEAVE_OF_RUN = 'where it was another, write set = { "sheave.mass" = ..., "sheave.inertia" = ... } in its run'
SHORT_REST = 1.0  # s at rest before a trip that references need


def new(
    campaign: str | Path,
    files: Sequence[str | Path],
    *,
    model: str | Path | RopeModel | None = None,
    ask: Ask | None = None,
) -> NewCampaign:
    """Describe raw logger files, one for each run: write campaign.toml, model and files into a folder; nothing is replaced.

    `model` is a model file, a preset's name or a `RopeModel`, by default the only model in the folder or the preset tower50.
    `ask(question, default)` returns the answer to what the files do not say; an answer that is not accepted is asked for again.
    Without `ask` guessed columns are left out and the sheave is the model's. Raises
    `InputError` if campaign.toml exists, or a file holds no motion of a car.
    """
    folder = Path(campaign)
    path = folder / "campaign.toml"
    _require_new(path, files)
    folder.mkdir(parents=True, exist_ok=True)
    loaded, name, remarks = _model(folder, model)
    surveyed = survey(folder, [_copied(Path(one), folder) for one in files], loaded, MotionColumn())
    found = roles(surveyed, loaded)
    found = {name: asked_role(name, role, loaded, ask) if ask else without_guess(role) for name, role in found.items()}
    used = {column: role for column, role in found.items() if role.quantity}
    channels = [(column, role, noise(surveyed, column)) for column, role in used.items()]
    if not channels:
        columns = ", ".join(found)
        raise InputError(f"{folder}: no column is a channel that is known; describe them in campaign.toml: {columns}")
    held_out = _held_out(surveyed)
    by_file = {run.file: "validate" if run.file == held_out else "fit" for run in surveyed}
    changes = {run.file: asked_changes(run.file, loaded, ask) if ask else {} for run in surveyed}
    runs = [(run.file, by_file[run.file], renamed(run, found), changes[run.file]) for run in surveyed]
    with atomic_write(path) as temporary:
        temporary.write_text(campaign_text(folder.resolve().name, name, _tables(surveyed), channels, runs), "utf-8")
    remarks += [f"{run.file}: {run.rest:.2g} s at rest before the trip; references at rest need {SHORT_REST:g} s"
                for run in surveyed if run.trip is not None and run.rest < SHORT_REST]  # fmt: skip
    if not ask:
        remarks.append(f"the sheave of the model, {loaded.sheave.mass:g} kg, is taken in every run; {SHEAVE_OF_RUN}")
    return NewCampaign(path, surveyed[0].car.column, found, by_file, tuple(remarks), check(path))


def _require_new(path: Path, files: Sequence[str | Path]) -> None:
    """Raise `InputError` if there is a campaign already, or no files, or some that are none."""
    if path.exists():
        raise InputError(f"{path}: exists and is not replaced; remove it, or name another folder")
    if not files:
        raise InputError("no files: name at least one file of a run")
    for one in files:
        require_regular_file(Path(one), None)


def _model(folder: Path, model: str | Path | RopeModel | None) -> tuple[RopeModel, str, list[str]]:
    """The model, the name of its file in the folder, where it is written if it is not there, and remarks."""
    if isinstance(model, RopeModel):
        target = folder / "model.toml"
        if target.exists():
            raise InputError(f"{target}: exists and is not replaced")
        dump(model, target)
        return model, target.name, []
    remarks = []
    if model is None:
        own = sorted(one for one in folder.glob("*.toml") if one.name != "campaign.toml")
        if len(own) == 1:
            return load(own[0]), own[0].name, []
        model = DEFAULT_MODEL
        remarks.append(f"no model was named: the preset {DEFAULT_MODEL} is taken; replace its data by those of your elevator")
    source = model_path(model)
    loaded = load(source)
    return loaded, _copied(source, folder), remarks


def _copied(source: Path, folder: Path) -> str:
    """The path of a file relative to the folder, into which it is copied if it does not lie there."""
    if source.resolve().is_relative_to(folder.resolve()):
        return source.resolve().relative_to(folder.resolve()).as_posix()
    target = folder / source.name
    if target.exists() and target.read_bytes() != source.read_bytes():
        raise InputError(f"{target}: exists with another content and is not replaced; rename {printable(source)}")
    if not target.exists():
        with atomic_write(target) as temporary:
            shutil.copyfile(source, temporary)
    return target.name


def _tables(runs: Sequence[SurveyedRun]) -> dict[str, dict[str, object]]:
    """What `[file]` and `[car]` must state, because the files do not."""
    units = {run.time_unit for run in runs}
    file: dict[str, object] = {}
    if len(units) == 1 and (unit := units.pop()):
        file["time_unit"] = unit
    car: dict[str, object] = {"column": runs[0].car.column}
    if runs[0].car.quantity != "position":
        car["quantity"] = runs[0].car.quantity
    return {"file": file, "car": car if len({run.car.column for run in runs}) == 1 else {}}


def _held_out(runs: Sequence[SurveyedRun]) -> str | None:
    """The run that is kept for validation: the one with the shortest travel; None of a single run."""
    return min(runs, key=lambda run: run.travel).file if len(runs) >= HELD_OUT else None
