"""The FMUs of a co-simulation: files that the user names, else our own, built once and kept in the cache of the user.

A file that merely lies in the present folder is never used: an FMU is a program.
"""

import hashlib
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import fmpy

from comprope.drive.cosimulation import NAME as DRIVE
from comprope.errors import InputError
from comprope.rope.model_file import as_table, load, validated
from comprope.rope.simulator.cosimulation import NAME as ROPE
from comprope.user_cache import entry_folder, verified_files

from ...presets import model_path
from ..fmu_export.recipes import Recipe, drive_recipe, rope_recipe


@dataclass(frozen=True)
class NamedFmus:
    """The files that the user names, by the name of their model: `CompensationRope` or `ElevatorDrive`."""

    files: tuple[tuple[str, Path], ...] = ()

    @classmethod
    def read(cls, paths: Iterable[str | Path]) -> "NamedFmus":
        """From paths; raises `InputError` for a file that is not an FMU of drive or rope, or for two of one model."""
        chosen: dict[str, Path] = {}
        for path in map(Path, paths):
            name = _model_name(path)
            if name in chosen:
                raise InputError(f"{path}: {chosen[name]} is an FMU of {name} too; one of each model is accepted")
            chosen[name] = path
        return cls(tuple(chosen.items()))

    def drive(self) -> Path:
        """Path of the drive's FMU."""
        return dict(self.files).get(DRIVE) or drive_fmu()

    def rope(self, sensors: int, own_effects: tuple[str, ...]) -> Path:
        """Path of the rope's FMU; our own has this number of sensors and these user-defined effects."""
        return dict(self.files).get(ROPE) or rope_fmu(sensors, own_effects)


def drive_fmu() -> Path:
    """Path of the drive's FMU with the installed code."""
    return _cached(drive_recipe())


def rope_fmu(sensors: int, own_effects: tuple[str, ...] = ()) -> Path:
    """Path of the FMU of a rope with this number of sensors and these user-defined effects, with the installed code."""
    return _cached(_rope_recipe(sensors, own_effects))


def _model_name(path: Path) -> str:
    try:
        description = fmpy.read_model_description(str(path), validate=False)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    except Exception as error:  # whatever fmpy finds wrong with a file that is no FMU
        raise InputError(f"{path}: not an FMU: {' '.join(str(error).split())}") from None
    if description.fmiVersion != "2.0" or description.modelName not in (DRIVE, ROPE):
        found = f"{description.modelName} for FMI {description.fmiVersion}"
        raise InputError(f"{path}: an FMU of {found}; one of {ROPE} or {DRIVE} for FMI 2.0 is accepted")
    return str(description.modelName)


def _cached(recipe: Recipe) -> Path:
    """The FMU of the recipe in the cache, built if absent; start values of its parameters may differ."""
    folder = entry_folder("fmu", _digest(recipe))
    built = folder / f"{recipe.interface.name}.fmu"
    with verified_files(folder, built.name):
        if not built.is_file():
            recipe.build(folder, reference=False)
    return built


@cache
def _rope_recipe(sensors: int, own_effects: tuple[str, ...]) -> Recipe:
    """Recipe of the rope's FMU; FMUs differ only in the number of sensors and user-defined effects."""
    places = [{"name": f"sensor{k + 1}", "side": "car", "height": 0.0} for k in range(sensors)]
    table = as_table(load(model_path("tower50"))) | {"sensors": places, "own_effects": own_effects}
    return rope_recipe(validated(table, "tower50"))


def _digest(recipe: Recipe) -> str:
    """Hash of everything that a built FMU depends on."""
    total = hashlib.sha256(repr((recipe.entry, sorted(recipe.data.items()), sys.version)).encode())
    for path, content in recipe.sources().items():
        total.update(path.encode() + b"\0" + content)
    return total.hexdigest()[:16]
