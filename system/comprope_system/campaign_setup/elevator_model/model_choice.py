"""The model of a new campaign: a file, a preset, a data sheet or answers, written into the campaign's folder."""

import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from comprope.atomic_files import atomic_write
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import dump, load, read_toml

from ...measurements.files.raw_table import printable
from ...presets import model_path
from ..questions import Ask
from .data_sheet import EstimatedModel, from_data_sheet, is_data_sheet
from .elevator_questions import asked_model

DEFAULT = "tower50"
WRITTEN = "model.toml"  # the name of a model that is no copy of a file


@dataclass(frozen=True)
class ChosenModel:
    """A model, the name of its file in the campaign's folder, remarks, and relative tolerances of its estimates by key."""

    model: RopeModel
    file: str
    remarks: tuple[str, ...] = ()
    tolerances: Mapping[str, float] = field(default_factory=dict)


def choose_model(folder: Path, model: str | Path | RopeModel | None, ask: Ask | None) -> ChosenModel:
    """The model, which is written or copied into the folder if it does not lie there.

    `model` is a model file, a data sheet, a preset's name or a model; by default the only model file in the folder, the answer to
    a question, or the preset tower50. Raises `InputError` for one that cannot be read, or would replace a file.
    """
    if isinstance(model, RopeModel):
        return _written(folder, EstimatedModel(model), "")
    remarks: tuple[str, ...] = ()
    if model is None:
        own = sorted(one for one in folder.glob("*.toml") if one.name != "campaign.toml")
        if len(own) == 1:
            model = own[0]
        elif ask:
            answer = asked_model(DEFAULT, ask)
            if isinstance(answer, dict):
                return _written(folder, from_data_sheet(answer, "answers"), "the answers to questions")
            model = answer
        else:
            model = DEFAULT
            remarks = (f"no model was named: the preset {DEFAULT} is taken; replace its data by those of your elevator",)
    source = model_path(model)
    table = read_toml(source)
    if is_data_sheet(table):
        return _written(folder, from_data_sheet(table, printable(source, 200)), source.name)
    loaded = load(source)
    return ChosenModel(loaded, copied(source, folder), remarks)


def _written(folder: Path, estimated: EstimatedModel, origin: str) -> ChosenModel:
    """The model as a file in the folder, with its estimates as comments."""
    target = folder / WRITTEN
    comment = "\n".join([f"Estimated by `comprope new` from {origin}:", *estimated.sentences, ""]) if origin else ""
    with TemporaryDirectory() as made:
        dump(estimated.model, Path(made) / WRITTEN, comment)
        copied(Path(made) / WRITTEN, folder)
    return ChosenModel(estimated.model, target.name, tuple(estimated.sentences), estimated.tolerances)


def copied(source: Path, folder: Path) -> str:
    """The path of a file relative to the folder, into which it is copied if it does not lie there."""
    if source.resolve().is_relative_to(folder.resolve()):
        return source.resolve().relative_to(folder.resolve()).as_posix()
    target = folder / source.name
    if target.exists() and target.read_bytes() != source.read_bytes():
        raise InputError(f"{target}: exists with another content and is not replaced; rename {printable(source.name)}")
    if not target.exists():
        with atomic_write(target) as temporary:
            shutil.copyfile(source, temporary)
    return target.name
