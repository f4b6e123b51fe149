"""Build the FMUs: `python build_fmu.py` writes dist/CompensationRope.fmu and dist/ElevatorDrive.fmu.

With `--native` it writes dist/CompensationRope-native.fmu as well, which needs no Python, and with `--fmi3` the same for
FMI 3.0, dist/CompensationRope-native-fmi3.fmu; with `--ssp` dist/Elevator.ssp, drive and rope connected, with the native
rope of FMI 2.0 if there is one.
"""

import argparse
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT / "fmu_src"))

from comprope import consent  # noqa: E402
from comprope.drive.cosimulation import ENTRY as DRIVE_ENTRY  # noqa: E402
from comprope.drive.cosimulation import interface as drive_interface  # noqa: E402
from comprope.errors import CompropeError, InputError  # noqa: E402
from comprope.fmi.package import Origin, build  # noqa: E402
from comprope.fmi.reference_result import reference_result  # noqa: E402
from comprope.fmi.ssp import Component, connections_by_name, write_ssp  # noqa: E402
from comprope.rope.effects import RopeModel  # noqa: E402
from comprope.rope.model_file import bundle, load  # noqa: E402
from comprope.rope.parameters import Sensor  # noqa: E402
from comprope.rope.simulator.cosimulation import ENTRY as ROPE_ENTRY  # noqa: E402
from comprope.rope.simulator.cosimulation import interface as rope_interface  # noqa: E402

DEFAULT_MODEL = ROOT / "system" / "comprope_system" / "presets" / "tower50.toml"


def main(arguments: list[str] | None = None) -> int:
    """Build both FMUs; returns the exit status: 0 done, 2 bad input, 1 anything else."""
    options = _options(arguments)
    try:
        with consent.giving(options.allow_code):
            sys.stdout.writelines(f"{path}\n" for path in _built(options))
    except CompropeError as error:
        sys.stderr.write(f"{error}\n")
        return 2 if isinstance(error, InputError) else 1
    return 0


def _built(options: argparse.Namespace) -> list[Path]:
    """Build all FMUs and systems that the options name."""
    origin = Origin(_version(), (ROOT / "LICENSE").read_text("utf-8"))
    built = [build_rope(options.model, options.sensors, options.out, origin), build_drive(options.out, origin)]
    versions = [version for version, wanted in (("2.0", options.native), ("3.0", options.fmi3)) if wanted]
    if versions:
        built += build_native_ropes(options.model, options.sensors, options.out, origin, versions)
    if options.ssp:
        rope = built[2 * options.native]
        built.append(build_ssp(model_with(options.model, options.sensors), rope, built[1], options.out))
    return built


def build_rope(model_file: Path, sensors: int | None, out: Path, origin: Origin) -> Path:
    """The rope's FMU; its parameters start at the values of a model file."""
    model = model_with(model_file, sensors)
    interface = rope_interface(model)
    return build(interface, ["rope"], ROPE_ENTRY, out, origin, bundle(model), extra=reference_result(interface))


def build_native_ropes(model_file: Path, sensors: int | None, out: Path, origin: Origin, versions: list[str]) -> list[Path]:
    """The rope's FMUs that need no Python, for some versions of FMI and every system that this one can compile for."""
    from comprope.native.linker import toolchain
    from comprope.native.package import FMI_VERSIONS, build_native

    sys.stderr.write(f"compiling with {toolchain()}\n")
    chosen = [one for one in FMI_VERSIONS if one.version in versions]
    return build_native(rope_interface(model_with(model_file, sensors)), out, origin, chosen)


def build_drive(out: Path, origin: Origin) -> Path:
    """The drive's FMU."""
    interface = drive_interface()
    return build(interface, ["drive"], DRIVE_ENTRY, out, origin, extra=reference_result(interface))


def build_ssp(model: RopeModel, rope: Path, drive: Path, out: Path) -> Path:
    """Drive and rope as one system: whatever has the same name is connected."""
    rope_part = Component("rope", rope, rope_interface(model), {"derivative_inputs": True})
    components = [Component("drive", drive, drive_interface()), rope_part]
    return write_ssp(out / "Elevator.ssp", "Elevator", components, connections_by_name(components))


def model_with(model_file: Path, sensors: int | None) -> RopeModel:
    """The model of a file, with another number of sensors if one is given."""
    model = load(model_file)
    return model if sensors is None else with_sensors(model, sensors)


def with_sensors(model: RopeModel, count: int) -> RopeModel:
    """The model with its first `count` sensors; missing ones are added half-way up, alternately on either side."""
    if not 0 <= count <= 1000:
        raise InputError(f"--sensors {count}: 0 to 1000 is accepted")
    taken = {sensor.name for sensor in model.sensors}
    names = [name for number in range(1, count + len(taken) + 1) if (name := f"sensor{number}") not in taken]
    sides = ("counterweight", "car")
    height = 0.5 * model.shaft.height
    added = [Sensor(name=name, side=sides[place % 2], height=height) for place, name in enumerate(names)]  # type: ignore[arg-type]
    return model.model_copy(update={"sensors": (*model.sensors, *added)[:count]})


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--model", type=Path, default=DEFAULT_MODEL, metavar="MODEL.toml", help="rope model to start from")
    parser.add_argument("--sensors", type=int, metavar="N", help="number of displacement sensors; default: those of the model")
    parser.add_argument("--out", type=Path, default=ROOT / "dist", metavar="DIR", help="folder to write to (default: dist)")
    parser.add_argument("--ssp", action="store_true", help="drive and rope also as one system, connected")
    parser.add_argument("--native", action="store_true", help="the rope also as an FMU that needs no Python")
    parser.add_argument("--fmi3", action="store_true", help="the rope also as an FMU for FMI 3.0 that needs no Python")
    parser.add_argument("--allow-code", action="store_true", help="run the files of own effects that the model names")
    return parser.parse_args(arguments)


def _version() -> str:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return str(project["version"])


if __name__ == "__main__":
    sys.exit(main())
