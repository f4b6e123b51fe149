"""The public function `comprope_system.fmu`: the FMUs of a rope model and of the drive."""

import tempfile
from pathlib import Path

from comprope.drive.cosimulation import interface as drive_interface
from comprope.errors import InputError
from comprope.fmi.ssp import Component, connections_by_name, write_ssp
from comprope.rope.effects import RopeModel
from comprope.rope.parameters import Sensor
from comprope.rope.simulator.cosimulation import interface as rope_interface

from ...parallel.progress import Progress, no_progress
from ...presets.inputs import ModelInput, model_name, read_model
from ...presets.overrides import Changes
from .recipes import drive_recipe, origin, rope_recipe
from .result import FmuResult

MOST_SENSORS = 1000  # more would make a model description of megabytes
SYSTEM = "Elevator"  # name of the SSP system and of its file


def fmu(
    model: ModelInput,
    *,
    changes: Changes | None = None,
    sensors: int | None = None,
    native: bool = False,
    fmi3: bool = False,
    ssp: bool = False,
    progress: Progress = no_progress,
) -> FmuResult:
    """Build the FMUs of rope and drive; the result's `save(folder)` writes them.

    `model` is a model file, a preset's name or a `RopeModel` that has the start values of the rope's parameters; `changes` are
    values by key; `sensors` is another number of sensors. With `native` and `fmi3` both are also compiled, for FMI 2.0 and
    3.0; with `ssp` drive and rope are also connected in one system, the native ones of FMI 2.0 if there are any. Raises
    `InputError` for invalid input or where there is no C compiler.
    """
    chosen = read_model(model, changes)
    rope = chosen if sensors is None else with_sensors(chosen, sensors)
    versions = [version for version, wanted in (("2.0", native), ("3.0", fmi3)) if wanted]
    total, built = 2 + bool(versions) + ssp, list[Path]()
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        recipes = (rope_recipe(rope), drive_recipe())
        for recipe in recipes:
            progress(f"building {recipe.interface.name}", len(built), total)
            built.append(recipe.build(out, reference=True))
        if versions:
            progress("compiling rope and drive", 2, total)
            built += _native_fmus(rope, out, versions)
        if ssp:
            progress(f"building {SYSTEM}", total - 1, total)
            first = len(recipes) if native else 0
            built.append(elevator_system(rope, built[first], built[first + 1]))
        return FmuResult({path.name: path.read_bytes() for path in built}, rope, model_name(model))


def with_sensors(model: RopeModel, count: int) -> RopeModel:
    """The model with its first `count` sensors; missing ones are added half-way up, alternately on either side."""
    if not 0 <= count <= MOST_SENSORS:
        raise InputError(f"sensors = {count}: a whole number from 0 to {MOST_SENSORS} is accepted")
    taken = {sensor.name for sensor in model.sensors}
    names = [name for number in range(1, count + len(taken) + 1) if (name := f"sensor{number}") not in taken]
    sides = ("counterweight", "car")
    height = 0.5 * model.shaft.height
    added = [Sensor(name=name, side=sides[place % 2], height=height) for place, name in enumerate(names)]  # type: ignore[arg-type]
    return model.model_copy(update={"sensors": (*model.sensors, *added)[:count]})


def _native_fmus(model: RopeModel, out: Path, versions: list[str]) -> list[Path]:
    """The FMUs of rope and drive that need no Python, by version, for every system that this one can compile for."""
    from comprope.native.drive_component import drive_component
    from comprope.native.package import FMI_VERSIONS, build_native
    from comprope.native.rope_component import rope_component

    chosen = [one for one in FMI_VERSIONS if one.version in versions]
    components = (rope_component(rope_interface(model)), drive_component(drive_interface()))
    made = [build_native(one, out, origin(), chosen) for one in components]
    return [path for paths in zip(*made, strict=True) for path in paths]


def elevator_system(model: RopeModel, rope: Path, drive: Path) -> Path:
    """Drive and rope as one system beside the rope's FMU: whatever has the same name is connected."""
    rope_part = Component("rope", rope, rope_interface(model), {"derivative_inputs": True})
    components = [Component("drive", drive, drive_interface(), exposed=("destination",)), rope_part]
    return write_ssp(rope.with_name(f"{SYSTEM}.ssp"), SYSTEM, components, connections_by_name(components))
