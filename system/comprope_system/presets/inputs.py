"""Reading of models and drives: from a file, the name of a preset, or a loaded object."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from comprope.drive.parameters import Drive
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import load, read_toml, with_changes
from comprope.validation_messages import validation_problems

from . import drive_path, model_path
from .overrides import Changes, by_key

ModelInput = str | Path | RopeModel
DriveInput = str | Path | Drive
Tables = Mapping[str, Mapping[str, Any]]


def read_model(model: ModelInput, changes: Changes | None = None) -> RopeModel:
    """The model of a file or preset, with some values changed; raises `InputError` as `load` and `with_changes` do."""
    loaded = model if isinstance(model, RopeModel) else load(model_path(model))
    return with_changes(loaded, *by_key(changes))


def require_still_building(model: RopeModel, purpose: str) -> RopeModel:
    """The model; raises `InputError` for one with `[building]` where its record is not replayed."""
    if model.building is not None:
        raise InputError(f"building: accepted by `comprope simulate` alone; {purpose} takes a building at rest: remove the table")
    return model


def model_name(model: ModelInput) -> str:
    """Name of the model in reports: the given file or preset."""
    return "model" if isinstance(model, RopeModel) else str(model)


def read_drive(drive: DriveInput | None, model: ModelInput, changes: Tables) -> Drive:
    """The drive that is given, else the preset's own, else one of default values; `changes` by table and key."""
    if drive is None and not isinstance(model, RopeModel):
        drive = drive_path(str(model))
    return load_drive(drive, changes)


def load_drive(drive: DriveInput | None, changes: Tables | None = None) -> Drive:
    """The drive of a parameter file (tables as `[profile]`), or a loaded one, with `changes` by table and key on top of it.

    Raises `InputError` naming all problems, as for model files.
    """
    table = drive.model_dump() if isinstance(drive, Drive) else read_toml(drive) if drive else {}
    changed = dict(changes or {})
    _validated(table, str(drive))
    return _validated({key: {**table.get(key, {}), **changed.get(key, {})} for key in {*table, *changed}}, "drive")


def _validated(table: Mapping[str, Any], source: str) -> Drive:
    try:
        return Drive.model_validate(table)
    except ValidationError as error:
        raise InputError("\n".join(f"{source}: {line}" for line in validation_problems(error, Drive))) from None
