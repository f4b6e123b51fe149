"""Finds or builds the FMUs: those in `dist/` if they contain the installed code, else in the cache of the user."""

import hashlib
import sys
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import metadata
from pathlib import Path

import fmpy

import comprope
from comprope.drive.cosimulation import ENTRY as DRIVE_ENTRY
from comprope.drive.cosimulation import interface as drive_interface
from comprope.fmi.model_interface import ModelInterface
from comprope.fmi.package import Origin, build
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table, bundle, load, validated
from comprope.rope.simulator.cosimulation import ENTRY as ROPE_ENTRY
from comprope.rope.simulator.cosimulation import interface as rope_interface
from comprope.user_cache import entry_folder, verified_files

from ..presets import model_path

_SOURCES = Path(comprope.__file__).parent


@dataclass(frozen=True)
class Recipe:
    """Source of an FMU: a model, its subpackage of `comprope`, and the entry module."""

    interface: ModelInterface
    package: str
    entry: str
    data: Mapping[str, bytes] = field(default_factory=dict)


def drive_fmu() -> Path:
    """Path of the drive's FMU with the installed code."""
    return locate(Recipe(drive_interface(), "drive", DRIVE_ENTRY))


def rope_fmu(sensors: int, own_effects: tuple[str, ...] = ()) -> Path:
    """Path of the FMU of a rope with this number of sensors and these user-defined effects, with the installed code."""
    return locate(_rope_recipe(sensors, own_effects))


def build_fmus(model: RopeModel, folder: Path) -> list[Path]:
    """The FMUs of the rope, whose parameters start at the values of the model, and of the drive, written into a folder."""
    rope = Recipe(rope_interface(model), "rope", ROPE_ENTRY, bundle(model))
    drive = Recipe(drive_interface(), "drive", DRIVE_ENTRY)
    return [build(one.interface, [one.package], one.entry, folder, _origin(), one.data) for one in (rope, drive)]


def locate(recipe: Recipe, dist: Path | None = None) -> Path:
    """An FMU of the recipe, built if there is none yet; the start values of its parameters may differ.

    Looked for in `dist` (by default the folder of that name where the command runs), then in the cache.
    """
    built = (dist or Path("dist")) / f"{recipe.interface.name}.fmu"
    if built.is_file() and _is_current(built, recipe):
        return built
    folder = entry_folder("fmu", _digest(recipe))
    with verified_files(folder, built.name):
        if not (folder / built.name).is_file():
            build(recipe.interface, [recipe.package], recipe.entry, folder, _origin(), recipe.data)
    return folder / built.name


@cache
def _rope_recipe(sensors: int, own_effects: tuple[str, ...]) -> Recipe:
    """Recipe of the rope's FMU; FMUs differ only in the number of sensors and user-defined effects."""
    places = [{"name": f"sensor{k + 1}", "side": "car", "height": 0.0} for k in range(sensors)]
    table = as_table(load(model_path("tower50"))) | {"sensors": places, "own_effects": own_effects}
    model = validated(table, "tower50")
    return Recipe(rope_interface(model), "rope", ROPE_ENTRY, bundle(model))


def _is_current(path: Path, recipe: Recipe) -> bool:
    """Whether an FMU has the recipe's variables and our present sources, file by file."""
    try:
        names = sorted(one.name for one in fmpy.read_model_description(str(path)).modelVariables)
        with zipfile.ZipFile(path) as archive:
            inside = {_within_package(name): name for name in archive.namelist() if name.startswith("resources/comprope_")}
            files = {file.relative_to(_SOURCES).as_posix(): file.read_bytes() for file in _sources(recipe)}
            files |= {name: content for name, content in recipe.data.items() if name.endswith(".py")}
            same = all(name in inside and archive.read(inside[name]) == content for name, content in files.items())
    except Exception:  # whatever is wrong with a file of that name, it is not the FMU we look for
        return False
    return same and names == sorted(one.name for one in recipe.interface.variables)


def _within_package(name: str) -> str:
    """`resources/comprope_rope_1234/rope/band.py` as `rope/band.py`."""
    return "/".join(name.split("/")[2:])


def _sources(recipe: Recipe) -> list[Path]:
    """The files copied into an FMU: top-level modules and those of the model."""
    return sorted([*_SOURCES.glob("*.py"), *(_SOURCES / recipe.package).rglob("*.py")])


def _digest(recipe: Recipe) -> str:
    """Hash of everything that a built FMU depends on."""
    total = hashlib.sha256(repr((recipe.entry, sorted(recipe.data.items()), sys.version)).encode())
    for file in [*_sources(recipe), *sorted((_SOURCES / "fmi").rglob("*.py"))]:
        total.update(file.relative_to(_SOURCES).as_posix().encode() + b"\0" + file.read_bytes())
    return total.hexdigest()[:16]


def _origin() -> Origin:
    try:
        own = metadata.distribution("comprope")
    except metadata.PackageNotFoundError:  # run from its sources
        return Origin("0", "MIT")
    return Origin(own.version, own.read_text("licenses/LICENSE") or own.read_text("LICENSE") or "MIT")
