"""Model files: a rope model as TOML, read with all its errors reported at once, written completely or not at all."""

import os
import re
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from pydantic import ValidationError

from .. import consent
from ..atomic_files import atomic_write, read_text_file
from ..errors import InputError
from ..validation_messages import validation_problems
from .effects import INSTRUMENT, RopeModel, model_type, user_effects

_NO_KEY = "not the key of a single value in this model, such as sheave.mass or sensors[1].height"


def load(path: str | Path, *, allow_code: bool = False) -> RopeModel:
    """The rope model in a TOML file; `allow_code` is consent to execute the files named in `own_effects`.

    Raises `InputError` naming every problem of the file, one line each: key, value and what is accepted.
    """
    table = read_toml(path)
    if files := _own_files(table):
        table["own_effects"] = _run_files([Path(path).parent / file for file in files], str(path), allow_code)
    if record := _record(table):
        table["building"]["record"] = _found_record(Path(path).parent, record, str(path))
    return validated(table, str(path))


def dump(model: RopeModel, path: str | Path, comment: str = "") -> None:
    """Write the model as a TOML file that `load` reads back equal; `comment` heads the file.

    The file is written completely or not at all. Raises `InputError` if it cannot be written.
    """
    import tomli_w  # needed for writing only, so that an FMU, which reads, does without it

    table = as_table(model)
    if model.own_effects:
        table["own_effects"] = [_seen_from(Path(path).resolve().parent, file) for file in model.own_effects]
    if record := _record(table):
        table["building"]["record"] = _seen_from(Path(path).resolve().parent, record)
    sensors = table.pop("sensors", [])
    blocks = [tomli_w.dumps(table)] + [f"\n[[sensors]]\n{tomli_w.dumps(sensor)}" for sensor in sensors]
    printable = ("".join(letter if letter.isprintable() else " " for letter in line) for line in comment.splitlines())
    heading = "".join(f"# {line}".rstrip() + "\n" for line in printable)
    with atomic_write(path) as temporary:
        temporary.write_text(heading + "".join(blocks), encoding="utf-8", newline="\n")


def with_changes(model: RopeModel, changes: Mapping[str, Any], source: str = "change") -> RopeModel:
    """The model with some values replaced, e.g. `{"sheave.mass": 120.0, "effects.air_drag.drag_coefficient": 1.0}`.

    A key is the path of a value in the model file; `sensors[1].height` is the first sensor's. Naming
    a parameter of an absent effect brings the effect in. Raises `InputError` as `load` does, each
    line prefixed by `source`, the origin of the changes.
    """
    table = as_table(model)
    for key, value in changes.items():
        try:
            _assign(table, _path(key), value)
        except LookupError:
            raise InputError(f"{source}: {key} = {value}: {_NO_KEY}") from None
    return validated(table, source)


def validated(table: Mapping[str, Any], source: str) -> RopeModel:
    """The model of a table; each line of an `InputError` begins with `source`.

    Files of user-defined effects are absolute paths, or relative to the working directory.
    """
    files = _own_files(table)
    if unknown := [file for file in files if file not in user_effects.FILES]:
        files = [*(file for file in files if file in user_effects.FILES), *_run_files(map(Path, unknown), source)]
        table = {**table, "own_effects": files}
    kind = model_type(files)
    try:
        return kind.model_validate(_frozen(table))
    except ValidationError as error:
        raise InputError("\n".join(f"{source}: {line}" for line in validation_problems(error, kind))) from None


def as_table(model: RopeModel) -> dict[str, Any]:
    """The model as nested plain tables, absent effects left out, as it stands in a model file."""
    table = model.model_dump(exclude_none=True)
    table |= {"sensors": list(table["sensors"]), "own_effects": list(model.own_effects)}
    return {key: value for key, value in table.items() if value not in ({}, [])}


def bundle(model: RopeModel) -> dict[str, bytes]:
    """Files of a model for an FMU, by path: model.toml and the files of user-defined effects.

    An FMU has the building's motion as inputs, and no record.
    """
    with TemporaryDirectory() as folder:
        inside = Path(folder).resolve()
        renamed = [inside / "own_effects" / f"{k}_{Path(file).name}" for k, file in enumerate(model.own_effects, 1)]
        dump(model.model_copy(update={"own_effects": tuple(map(str, renamed)), "building": None}), inside / "model.toml")
        files = {"model.toml": (inside / "model.toml").read_bytes()}
    for old, new in zip(model.own_effects, renamed, strict=True):
        files[new.relative_to(inside).as_posix()] = user_effects.FILES[old].text.encode()
    return files


def _own_files(table: Mapping[str, Any]) -> list[str]:
    """The value of own_effects; empty if it is not a list of strings, which is reported by the validation."""
    files = table.get("own_effects", ())
    return list(files) if isinstance(files, list | tuple) and all(isinstance(one, str) for one in files) else []


def _record(table: Mapping[str, Any]) -> str | None:
    """The value of building.record; None if there is none, or it is no text, which is reported by the validation."""
    building = table.get("building")
    record = building.get("record") if isinstance(building, Mapping) else None
    return record if isinstance(record, str) else None


def _found_record(folder: Path, record: str, source: str) -> str:
    """The absolute path of a record; raises `InputError` for one outside of the model's folder without consent."""
    found = (folder / record).resolve()
    if not found.is_relative_to(folder.resolve()) and not consent.outside_given():
        raise InputError(
            f"{source}: building.record = {record}: lies outside of the model's folder; copy it there, or allow it: comprope "
            "--allow-outside COMMAND ..."
        )
    return str(found)


def _run_files(files: Iterable[Path], source: str, allow_code: bool = False) -> list[str]:
    """Files of own effects, run where they have not been, by their absolute paths."""
    found, wrong = [str(file.resolve()) for file in files], []
    for file in found:
        try:
            user_effects.load_file(Path(file), allow_code=allow_code)
        except InputError as error:
            wrong.append(f"{source}: own_effects: {error}")
    if wrong:
        raise InputError("\n".join(wrong))
    return found


def _seen_from(folder: Path, file: str) -> str:
    """The path of a file relative to a folder; unchanged if they are on different drives."""
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:
        return file


def read_toml(path: str | Path) -> dict[str, Any]:
    """The tables of a TOML file; raises `InputError` if it is absent, unreadable, not UTF-8 or not TOML."""
    try:
        return tomllib.loads(read_text_file(path))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: not valid TOML: {error}") from None
    except RecursionError:
        raise InputError(f"{path}: not valid TOML: nested too deeply") from None


def _frozen(value: Any) -> Any:
    """The same tables with tuples in place of lists, as required by frozen components."""
    if isinstance(value, Mapping):
        return {key: _frozen(item) for key, item in value.items()}
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


def _path(key: str) -> list[str | int]:
    """`sensors[1].height` as `["sensors", 0, "height"]`."""
    parts = key.split(".", 2)
    if len(parts) == 3 and parts[0] == "effects" and parts[1] in INSTRUMENT:
        return list(parts)  # a channel's name is whatever a logger wrote
    if not re.fullmatch(r"\w+(\[[1-9]\d*\])?(\.\w+(\[[1-9]\d*\])?)*", key):
        raise LookupError(key)
    return [int(part[1:]) - 1 if part.startswith("[") else part for part in re.findall(r"\[\d+|\w+", key)]


def _assign(table: dict[str, Any], path: list[str | int], value: Any) -> None:
    """Set the value at a path, creating tables as needed; raises `LookupError` for an invalid path."""
    place: Any = table
    for part in path[:-1]:
        if isinstance(place, list) and isinstance(part, int):
            place = place[part]
        elif isinstance(place, dict) and isinstance(part, str):
            place = place.setdefault(part, {})
        else:
            raise LookupError(path)
    if not isinstance(place, dict):
        raise LookupError(path)
    place[path[-1]] = value
