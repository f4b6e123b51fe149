"""What the FMUs that run in Python are made of: a model, its code, and the version and licence of this package."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path

import comprope
from comprope.drive.cosimulation import ENTRY as DRIVE_ENTRY
from comprope.drive.cosimulation import interface as drive_interface
from comprope.fmi.model_interface import ModelInterface
from comprope.fmi.package import Origin, build
from comprope.fmi.reference_result import reference_result
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import bundle
from comprope.rope.simulator.cosimulation import ENTRY as ROPE_ENTRY
from comprope.rope.simulator.cosimulation import interface as rope_interface

_CODE = Path(comprope.__file__).parent


@dataclass(frozen=True)
class Recipe:
    """Source of an FMU: a model, its subpackages of `comprope`, the entry module, and files beside it."""

    interface: ModelInterface
    packages: tuple[str, ...]
    entry: str
    data: Mapping[str, bytes] = field(default_factory=dict)

    def build(self, folder: Path, *, reference: bool) -> Path:
        """Write the FMU into a folder, with the reference result if wanted, and return its path."""
        extra = reference_result(self.interface) if reference else None
        return build(self.interface, list(self.packages), self.entry, folder, origin(), self.data, extra=extra)

    def sources(self) -> dict[str, bytes]:
        """The code that is copied into the FMU, by path: top-level modules, the FMI's, and those of the model."""
        folders = (_CODE / name for name in ("fmi", *self.packages))
        files = [*_CODE.glob("*.py"), *(file for folder in folders for file in folder.rglob("*.py"))]
        return {file.relative_to(_CODE).as_posix(): file.read_bytes() for file in sorted(files)}


def rope_recipe(model: RopeModel) -> Recipe:
    """The rope; its parameters start at the values of the model."""
    return Recipe(rope_interface(model), ("kernels", "rope"), ROPE_ENTRY, bundle(model))


def drive_recipe() -> Recipe:
    """The drive."""
    return Recipe(drive_interface(), ("kernels", "drive"), DRIVE_ENTRY)


def origin() -> Origin:
    """Version and licence: those of the repository that the code lies in, else those of the installed package."""
    repository = _CODE.parent.parent
    if _CODE.parent.name == "fmu_src" and (repository / "pyproject.toml").is_file():
        project = tomllib.loads((repository / "pyproject.toml").read_text("utf-8"))["project"]
        return Origin(str(project["version"]), (repository / "LICENSE").read_text("utf-8"))
    try:
        own = metadata.distribution("comprope")
    except metadata.PackageNotFoundError:  # unpacked, not installed
        return Origin("0", "MIT")
    return Origin(own.version, own.read_text("licenses/LICENSE") or "MIT")
