"""The rope's FMU that needs no Python: valid, the same to the last bit, and unshakeable."""

import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fmpy
import llvmlite.binding as llvm
import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

import comprope
from comprope.errors import CompropeError, InputError
from comprope.fmi.model_description import complete_description
from comprope.fmi.package import BINARIES, BINARY
from comprope.fmi.pythonfmu_slave import pythonfmu_description
from comprope.fmi.reference_result import INPUT_FILE, OUTPUT_FILE
from comprope.native import linker
from comprope.native.c_source import quoted
from comprope.native.fmi2_package import universal_binary
from comprope.native.llvm_ir import require_no_python, rope_sizes
from comprope.native.python_binary import python_binaries
from comprope.native.targets import TARGETS
from comprope.rope.runtime.status import MESSAGES, require_success
from comprope_system import presets

from .fmi_pair import SMALL, Pair
from .native_fmu import HOSTED, ORIGIN, compiler, native_fmu, tower
from .own_effects import FILES

HEADERS = Path(fmpy.__file__).parent / "c-code"
HOST = Path(__file__).parent / "native_host.c"
# In place of the tower's: friction, axial, bending and external damping.
CALM = {
    "contact.friction_coefficient": 0.05,
    "rope.axial_damping": 4e4,
    "rope.bending_damping": 2.0,
    "rope.external_damping": 3.0,
}
EFFECTS = {
    "effects.air_drag.drag_coefficient": 1.1, "effects.shaft_airflow.crossflow_ratio": 0.2,
    "effects.bending_hysteresis.friction_moment": 0.5, "effects.intrinsic_curvature.curvature": 0.1,
    "effects.sheave_eccentricity.eccentricity": 0.001, "effects.bearing_friction.coulomb_torque": 2.0,
    "effects.guide_friction.coulomb_force": 20.0, "effects.sheave_damper.damping": 1e3,
    "effects.building_sway.amplitude": 0.05, "effects.attachment_offset.car": 0.01, "sheave.mass": 60.0,
}  # fmt: skip

pytestmark = compiler


@pytest.fixture(scope="module")
def fmu() -> Path:
    return native_fmu()


@pytest.fixture
def pair(fmu: Path) -> Iterator[Pair]:
    made = Pair(fmu, tower())
    yield made
    made.free()


def test_valid_and_complete(fmu: Path) -> None:
    assert validate_fmu(str(fmu)) == []
    with zipfile.ZipFile(fmu) as archive:
        names = set(archive.namelist())
        page = archive.read("documentation/index.html").decode()
    assert {"model.png", "documentation/licenses/license.txt", "documentation/licenses/fmi-headers.txt"} <= names
    assert "documentation/c/model.c" in names and "documentation/c/rope.c" in names and "documentation/c/drive.c" not in names
    assert "sheave.mass" in page and "fmi2Error" in page and "pip install" not in page
    assert not any(name.endswith(".py") for name in names)


def test_same_description_as_the_fmu_in_python(fmu: Path) -> None:
    other = ET.fromstring(complete_description(pythonfmu_description(tower()), tower(), "1.2.3", ""))
    with zipfile.ZipFile(fmu) as archive:
        own = ET.fromstring(archive.read("modelDescription.xml"))
    for tag in ("ModelVariables", "ModelStructure", "UnitDefinitions", "DefaultExperiment"):
        assert [(one.tag, one.attrib) for one in own.find(tag).iter()] == [
            (one.tag, one.attrib) for one in other.find(tag).iter()
        ]
    cosimulation = own.find("CoSimulation").attrib
    told = ("needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess")
    able = ("canGetAndSetFMUstate", "canSerializeFMUstate", "canHandleVariableCommunicationStepSize")
    assert {cosimulation[name] for name in told} == {"false"} and {cosimulation[name] for name in able} == {"true"}


@pytest.mark.skipif(not shutil.which("nm"), reason="nm is not installed")
def test_needs_nothing_but_the_c_library(fmu: Path, tmp_path: Path) -> None:
    listed = subprocess.run(["nm", "-D", unpacked(fmu, tmp_path)], capture_output=True, text=True, check=True).stdout
    symbols = {line.split()[-1].partition("@")[0]: line.split()[-2] for line in listed.splitlines()}
    needed = {name for name, kind in symbols.items() if kind == "U"}
    memory = {"calloc", "free", "memcpy", "memset", "memcmp", "bcmp", "memmove", "strcmp", "strncpy"}
    text = {"snprintf", "vsnprintf", "__snprintf_chk", "__vsnprintf_chk", "__stack_chk_fail"}
    numbers = {"sin", "cos", "sincos", "exp", "pow", "rint", "ceil", "fmax", "fmin", "sqrt"}
    assert needed <= memory | text | numbers
    assert all(name.startswith(("fmi2", "fmi3", "_")) for name, kind in symbols.items() if kind == "T")


def unpacked(fmu: Path, folder: Path) -> Path:
    """The binary for this system."""
    target = TARGETS[linker.host_target()]
    with zipfile.ZipFile(fmu) as archive:
        name = f"{fmu.name.partition('_')[0]}.{target.extension}"
        return Path(archive.extract(f"binaries/{target.folder}/{name}", folder))


# -- the same numbers ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "values",
    [{}, EFFECTS | {"sheave.ropes": 3.0}, {"rope.element_length": 0.2, "shaft.height": 20.0, "counterweight_position": 20.0}],
)
@pytest.mark.parametrize("switches", [(False, False), (True, True)])
def test_same_bits_as_just_in_time(pair: Pair, values: dict[str, float], switches: tuple[bool, bool]) -> None:
    """On one machine: the library's sine is the same, and no sum is reordered for wider vector units."""
    top = values.get("shaft.height", 50.0)
    for name, value in zip(("derivative_inputs", "inputs_at_end"), switches, strict=True):
        pair.set_boolean(name, value)
    pair.set_reals(list(values), list(values.values()))
    pair.enter_initialization()
    pair.exit_initialization()
    pair.get_all()
    time = 0.0
    for count in range(60):
        dt = (0.01, 0.013, 0.004)[count % 3]
        at = time + dt * switches[1]
        ends = {"position": (0.3 * at * at, top - 0.3 * at * at), "velocity": (0.6 * at, -0.6 * at), "acceleration": (0.6, -0.6)}
        for what, both in ends.items():
            pair.set_reals([f"car_{what}", f"counterweight_{what}"], both)
        pair.do_step(dt)
        time += dt
    pair.get_all()
    assert pair.refusals == 0


def test_same_bits_with_slack_rope_stops_and_walls(pair: Pair) -> None:
    """Both ends go down faster than the sheave falls, and up again."""
    values = {
        "effects.end_stops.stiffness": 2e6, "effects.end_stops.damping": 2e4, "effects.end_stops.down": 0.01,
        "effects.tie_down.locking_damping": 1e4, "effects.tie_down.locking_speed": 0.1, "sheave.limit_switch": 0.005,
        "effects.shaft_walls.stiffness": 1e4, "effects.shaft_walls.distance": 0.02, "rope.element_length": 0.1,
    }  # fmt: skip
    pair.set_reals([*values, "car_position", "counterweight_position"], [*values.values(), 25.0, 25.0])
    pair.enter_initialization()
    pair.exit_initialization()
    for lowered in (0.004, 0.012, *[0.016] * 10, 0.008, *[0.0] * 8):
        pair.set_reals(["car_position", "counterweight_position"], [25.0 - lowered] * 2)
        pair.do_step(0.01)
    pair.get_all()
    seen = pair.oracle.instance.simulator.outputs()
    assert seen["slack_duration"] > 0.0 and seen["limit_switch"] and seen["peak_element_tension"] > 1000.0
    assert pair.refusals == 0


def test_damping_and_friction_may_change_between_steps(pair: Pair) -> None:
    """From the next step on, in energy balance; a saved state has them as well."""

    def ride(first: int, last: int) -> None:
        for k in range(first, last):
            height = 0.05 * (0.01 * k) ** 2
            pair.set_reals(["car_position", "counterweight_position"], [height, 1.0 - height])
            pair.do_step(0.01)

    names = ["car_end_tension", "energy_residual", "lateral_displacement[4]"]
    pair.start(SMALL | {"sensors[4].height": -0.3})
    ride(1, 30)
    pair.save_state()
    ride(30, 60)
    plain = pair.oracle.instance.get_values("real", [pair.references[name] for name in names])
    pair.restore_state(0, serialized=False)
    pair.set_reals(list(CALM), list(CALM.values()))
    ride(30, 45)
    pair.save_state()
    pair.set_reals(["contact.damping"], [2e4])
    pair.restore_state(1, serialized=True)
    ride(45, 60)
    pair.get_all()
    calm = pair.oracle.instance.get_values("real", [pair.references[name] for name in names])
    assert abs(plain[0] - calm[0]) > 1.0 and calm[1] == pytest.approx(plain[1], abs=1e-5)
    pair.set_reals(["rope.axial_damping"], [-1.0])
    pair.do_step(0.01)
    assert "parameter rope.axial_damping = -1 N.s: 0 to 1e+06 N.s is accepted" in pair.messages[0]


def test_simulates_in_fmpy(fmu: Path) -> None:
    result = simulate_fmu(str(fmu), stop_time=0.5, step_size=0.01, output_interval=0.01, start_values={"sheave.mass": 80.0})
    assert result["time"][-1] == pytest.approx(0.5, abs=1e-12)
    assert result["sheave_force"][-1] == pytest.approx(80.0 * 9.81, rel=1e-6)  # at rest, its weight


def test_the_reference_result_inside_is_met(fmu: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(fmu) as archive:
        given, expected = (read_csv(archive.extract(name, tmp_path)) for name in (INPUT_FILE, OUTPUT_FILE))
    names = [name for name in expected.dtype.names if name != "time"]
    found = simulate_fmu(str(fmu), stop_time=4.0, step_size=0.01, output_interval=0.01, input=given, output=names)[::5]
    nominal = {one.name: one.nominal for one in tower().variables}
    for name in names:
        # fmpy's times differ in their last digits, and the file holds nine.
        assert found[name] == pytest.approx(expected[name], rel=1e-6, abs=1e-6 * nominal[name]), name


# -- errors --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"sheave.mass": -3.0, "rope.diameter": 5.0}, "parameter rope.diameter = 5 m: 0.002 to 0.1 m is accepted (outer"),
        ({"sheave.mass": -3.0, "rope.diameter": 5.0}, "; parameter sheave.mass = -3 kg: 0.1 to 20000 kg is accepted (mass)"),
        ({"sheave.ropes": 1.5}, "sheave.ropes: 1.5 ropes; a whole number is accepted"),
        ({"rope.element_length": 0.3}, "rope.element_length = 0.3 m is too coarse for the sheave; at most half of "),
        ({"car_position": 60.0, "counterweight_position": -10.0}, "car_position = 60 m with counterweight_position = -10 m at t"),
    ],
)  # fmt: skip
def test_impossible_values_are_told(pair: Pair, values: dict[str, float], sentence: str) -> None:
    pair.set_reals(list(values), list(values.values()))
    pair.enter_initialization()
    pair.exit_initialization()
    assert pair.refusals == 1 and sentence in pair.messages[0]
    assert pair.messages[0].startswith("3 CompensationRope 'pair' at t = 0 s: ")


def test_a_lost_step_says_where_and_when(pair: Pair) -> None:
    pair.start(
        {
            "shaft.height": 10.0, "rope.element_length": 0.1, "effects.building_sway.amplitude": 5.0,
            "effects.building_sway.frequency": 20.0, "counterweight_position": 10.0, "sheave.mass": 5.0,
            "rope.mass_per_length": 0.1,
        }
    )  # fmt: skip
    while not pair.oracle.instance.failure and pair.oracle.instance.time < 1.0:
        pair.do_step(0.01)
    assert re.search(r"the time step at t = 0\.\d+ s did not converge .* worst at .*, height", pair.messages[0])
    pair.do_step(0.01)
    assert "no steps and outputs after an error, unless reset or restored; the error was: the time step" in pair.messages[0]


def test_a_failed_run_can_be_taken_back(pair: Pair) -> None:
    pair.start({})
    pair.save_state()
    pair.set_reals(["car_position"], [2000.0])
    pair.do_step(0.01)
    assert pair.refusals == 1
    pair.restore_state(0, serialized=True)
    pair.do_step(0.01)
    pair.get_all()
    assert pair.refusals == 1


def test_words_take_as_many_numbers_as_they_are_given() -> None:
    for status, (kind, text, count) in MESSAGES.items():
        assert len(re.findall(r"%[.\d]*[gef]", text)) == count
        with pytest.raises(kind):
            require_success(status, [1.0] * 6)


@compiler
def test_a_serialized_state_with_one_flipped_bit_is_refused(fmu: Path) -> None:
    pair = Pair(fmu, tower())
    pair.start({})
    pair.do_step(0.01)
    pair.require_flipped_bits_refused()
    pair.free()


def test_strings_of_c_hold_any_text() -> None:
    assert quoted('a "b"\\\n') == '"a \\042b\\042\\134\\012"'
    assert quoted("µ1") == '"\\302\\2651"'


# -- a host without Python -----------------------------------------------------------------------


@pytest.fixture(scope="module")
def host(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    return [compiled(HOST, tmp_path_factory.mktemp("host") / "host")]


def compiled(source: Path, program: Path, *options: str) -> str:
    compiler = [sys.executable, "-m", "ziglang", "cc"] if shutil.which("cc") is None else ["cc"]
    command = [*compiler, "-std=c11", "-O1", "-Wall", "-Wextra", "-Werror", f"-I{HEADERS}", *options, str(source)]
    subprocess.run([*command, "-o", str(program), "-ldl", "-lpthread", "-lm"], check=True)
    return str(program)


def hosted(host: list[str], scenario: str, fmu: Path, binary: Path, number: int) -> str:
    description = read_model_description(str(fmu))
    references = {one.name: str(one.valueReference) for one in description.modelVariables}
    names = HOSTED[description.modelName]
    arguments = [scenario, str(binary), description.guid, *(references[name] for name in names), str(number)]
    result = subprocess.run([*host, *arguments], capture_output=True, text=True, timeout=300, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.mark.skipif(sys.platform == "win32", reason="the host needs POSIX threads")
@pytest.mark.parametrize("name", HOSTED)
@pytest.mark.parametrize(("scenario", "number"), [("cycle", 20), ("threads", 3), ("states", 1), ("wrong", 1), ("memory", 1)])
def test_in_a_host_without_python(host: list[str], tmp_path: Path, name: str, scenario: str, number: int) -> None:
    """Loaded and unloaded, in threads, saved and restored, called wrongly, without memory; all is given back to the last byte."""
    fmu = native_fmu("native", name)
    assert hosted(host, scenario, fmu, unpacked(fmu, tmp_path), number).startswith(f"{scenario}: 0 failures")


# -- building ------------------------------------------------------------------------------------


BUILD = """\
import sys, zipfile
from pathlib import Path
from comprope.fmi.package import Origin
from comprope.native import linker, package
from comprope.native.rope_component import rope_component
from comprope.rope.simulator.cosimulation import interface
from comprope.rope.model_file import as_table, load, validated

model, out, fmu, version, licence, *effects = sys.argv[1:]
table = as_table(load(Path(model))) | {"own_effects": effects}
# Not computed again, since that would compile the kernels once more.
archive = zipfile.ZipFile(fmu)
package.reference_result = lambda _: {name: archive.read(name) for name in archive.namelist() if name.startswith("resources/")}
rope = rope_component(interface(validated(table, model)))
package.build_native(rope, Path(out), Origin(version, licence), package.FMI_VERSIONS, [linker.host_target()])
"""


def built_apart(out: Path, fmu: Path, sources: Path, *effects: Path) -> Path:
    """The same FMUs built by the package in `sources` in another process, with effects from files; that for FMI 2.0."""
    given = [str(presets.model_path("tower50")), str(out), str(fmu), ORIGIN.version, ORIGIN.licence, *map(str, effects)]
    places = os.pathsep.join([str(sources), os.environ.get("PYTHONPATH", "")])
    environment = os.environ | {"PYTHONPATH": places, "COMPROPE_ALLOW_CODE": "1"}
    subprocess.run([sys.executable, "-c", BUILD, *given], env=environment, check=True)
    assert sorted(path.name for path in out.iterdir()) == [fmu.name, native_fmu("native_fmi3").name]
    return out / fmu.name


@pytest.mark.slow
def test_same_source_same_bytes(fmu: Path, tmp_path: Path) -> None:
    """Built from elsewhere, in another process, with a remark in a file of kernels, which changes numba's names for all."""
    copy, out = tmp_path / "elsewhere" / "comprope", tmp_path / "out"
    shutil.copytree(Path(comprope.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))
    with (copy / "rope" / "runtime" / "status.py").open("r+") as file:  # fails if there is no such file
        file.seek(0, 2)
        file.write("# a remark\n")
    assert built_apart(out, fmu, copy.parent).read_bytes() == fmu.read_bytes()
    other = native_fmu("native_fmi3")
    assert (out / other.name).read_bytes() == other.read_bytes()


PULL = """\
from comprope.effect import Effect, acts, kernel, quantity, register, slot

class SheavePull(Effect):
    name = "sheave_pull"
    force: float = quantity("N", "downward pull on the sheave", 0.0, 1e4, off=0.0, nominal=100.0)

register(SheavePull)
FORCE = slot("effects.sheave_pull.force")

@kernel
def pull(n, t, p, q, v, w, f):
    f[n] += p[FORCE]
    return p[FORCE] * v[n]

acts(SheavePull, forces=pull)
"""


BESIDE = """\
import sys
from pathlib import Path
from comprope.rope.simulator.cosimulation import interface
from comprope.rope.model_file import as_table, load, validated
from tests.fmi_pair import Pair

model, fmu, *effects = sys.argv[1:]
rope = interface(validated(as_table(load(Path(model))) | {"own_effects": effects}, model))
pair = Pair(Path(fmu), rope)
brush = {"effects.pit_brush.damping": 20.0, "effects.pit_brush.top": 30.0, "effects.building_sway.amplitude": 0.05}
own = {"effects.rail_joints.kick": 0.02, "effects.pit_spring.stiffness": 1e4, "effects.root.size": 10.0}
pair.start(brush | own | {"rope.element_length": 0.2})
for k in range(1, 31):
    pair.set_reals(["car_position", "counterweight_position"], [1e-4 * k * k, 50.0 - 1e-4 * k * k])
    pair.do_step(0.01)
    pair.get_all()
assert pair.refusals == 0
"""


@pytest.mark.slow
def test_effects_from_files_are_compiled_in(fmu: Path, tmp_path: Path) -> None:
    """They do what they do just in time, to the last bit, and nothing while they are off."""
    root, model = Path(__file__).parent.parent, str(presets.model_path("tower50"))
    effects = [Path(one) for one in FILES["own_effects"]]  # as in other tests, whose compiled kernels serve here too
    made = built_apart(tmp_path / "out", fmu, Path(comprope.__file__).parents[1], *effects)
    command = [sys.executable, "-c", BESIDE, model, str(made), *map(str, effects)]
    subprocess.run(command, env=os.environ | {"COMPROPE_ALLOW_CODE": "1"}, cwd=root, check=True)
    assert validate_fmu(str(made)) == []
    short = {"stop_time": 0.1, "step_size": 0.01, "output_interval": 0.01}
    without, off = simulate_fmu(str(fmu), **short), simulate_fmu(str(made), **short)
    assert all(np.array_equal(without[name], off[name]) for name in without.dtype.names)
    on = simulate_fmu(str(made), **short, start_values={"effects.root.size": 10.0})
    lifted = 10.0 * np.sqrt(22.0)  # N, with the car at the bottom landing
    assert on["sheave_force"] == pytest.approx(without["sheave_force"] - lifted, rel=1e-6)  # at rest, to Newton's tolerance


OTHER = """\
import sys
from pathlib import Path
from comprope.native.c_source import kernels_header
from comprope.native.llvm_ir import rope_sizes
from comprope.native.rope_component import rope_component
from comprope.rope.effects import user_effects
from comprope.rope.model_file import load
from comprope.rope.simulator.cosimulation import interface

model = load(sys.argv[1])
found = rope_sizes({})
before = kernels_header(rope_component(interface(model), found))
user_effects.load_file(Path(sys.argv[2]), allow_code=True)
assert kernels_header(rope_component(interface(model), found)) == before
"""


def test_effects_of_other_models_stay_out(tmp_path: Path) -> None:
    (tmp_path / "pull.py").write_text(PULL)
    given = [str(presets.model_path("tower50")), str(tmp_path / "pull.py")]
    subprocess.run([sys.executable, "-c", OTHER, *given], check=True)


def test_a_kernel_that_needs_python_is_refused() -> None:
    def module(called: str) -> Any:
        return llvm.parse_assembly(f"declare ptr @{called}(i64)\ndeclare double @llvm.sin.f64(double)")

    require_no_python(module("sin"))
    with pytest.raises(CompropeError, match=r"they call NRT_Allocate, which only Python has; kernels may not allocate"):
        require_no_python(module("NRT_Allocate"))


def test_without_a_compiler_the_cure_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linker, "_zig", lambda: False)
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(InputError, match="no C compiler: `pip install ziglang`"):
        linker.toolchain()


def test_without_zig_only_this_system_is_compiled_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linker, "_zig", lambda: False)
    monkeypatch.setattr(shutil, "which", lambda name: name)
    assert linker.linkable_targets() == [linker.host_target()]
    expected = "cc, for this system only; `pip install ziglang` brings a compiler for Linux, Windows and"
    assert linker.toolchain().startswith(expected)


def test_one_file_for_several_processors() -> None:
    parts: list[Any] = [b"\xcf\xfa\xed\xfe" + number.to_bytes(4, "little") * 2 + bytes(5000) for number in (7, 12)]
    whole = universal_binary(parts)
    for place, part in enumerate(parts):
        at = int.from_bytes(whole[8 + 20 * place + 8 :][:4], "big")
        assert at % 16384 == 0 and whole[at : at + len(part)] == part


@pytest.mark.slow
def test_the_binary_of_the_fmus_in_python_is_built_from_its_sources():
    """With the version of zig that made it; linking for Windows takes a minute."""
    pytest.importorskip("ziglang")
    for system, content in python_binaries().items():
        assert content == (BINARY / f"{system}.{BINARIES[system]}").read_bytes(), system


def test_modules_in_the_present_folder_are_not_run(tmp_path, monkeypatch):
    """The kernels are translated in a process of its own, which must not take a stranger's folder for its library."""
    for name in ("numba", "json", "comprope"):
        (tmp_path / f"{name}.py").write_text("from pathlib import Path\nPath('run').touch()\n")
    monkeypatch.chdir(tmp_path)
    assert set(rope_sizes({})) == {40, 41, 50}
    assert not (tmp_path / "run").exists()
