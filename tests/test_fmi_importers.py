"""A toy FMU as importers see it: valid, repeatable, restorable, honest about errors, and never deadly."""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path
from urllib.parse import quote

import fmpy
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

import comprope
from comprope.fmi.package import BINARIES, Origin, build

TOYS = Path(__file__).parent / "fmi_toys"
comprope.__path__.append(str(TOYS))
from comprope.spring.cosimulation import Spring, interface  # noqa: E402

ENTRY = "from .spring.cosimulation import interface\n\nINTERFACE = interface(0.25)\n"
ERROR = "3"


def built(out: Path, root: Path = TOYS) -> Path:
    return build(interface(0.25), ["spring"], ENTRY, out, Origin("1.2.3", "MIT"), root=root)


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return built(tmp_path_factory.mktemp("fmu"))


@pytest.fixture(scope="module")
def other_build(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same model with another `helper` module."""
    root = tmp_path_factory.mktemp("other")
    shutil.copytree(TOYS / "spring", root / "spring", ignore=shutil.ignore_patterns("__pycache__"))
    (root / "spring" / "helper.py").write_text('"""Another helper."""\n\nWORD = "other"\n')
    return built(root / "dist", root)


def hosted(scenario: str, *paths: Path | str, stdin: str = "", logging: bool = False) -> subprocess.CompletedProcess[str]:
    """Run a scenario of `host.py`; it must come to its end."""
    command = [sys.executable, str(TOYS / "host.py"), scenario, *map(str, paths), *(["logging"] if logging else [])]
    result = subprocess.run(command, input=stdin, capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == 0, result.stderr
    assert result.stdout.splitlines()[-1] == "ALIVE", result.stdout
    return result


def told(result: subprocess.CompletedProcess[str], word: str) -> list[str]:
    return [line.removeprefix(word + " ") for line in result.stdout.splitlines() if line.startswith(word + " ")]


def direct(steps: int, force: float = 0.0) -> Spring:
    """The toy without any FMU around it."""
    parameters = {"spring.mass": 2.0, "spring.stiffness": 0.1 + 0.2, "spring.place": 0.25}
    spring = Spring(parameters, {"force": force, "mirror": False}, 0.0)
    for count in range(steps):
        spring.step(count * 0.01, 0.01, {"force": force, "mirror": False})
    return spring


def test_valid(fmu: Path) -> None:
    assert validate_fmu(str(fmu)) == []


def test_same_source_same_bytes(fmu: Path, other_build: Path, tmp_path: Path) -> None:
    assert built(tmp_path).read_bytes() == fmu.read_bytes()
    assert list(tmp_path.iterdir()) == [tmp_path / "Spring.fmu"]
    assert read_model_description(str(other_build)).guid != read_model_description(str(fmu)).guid


def test_contents(fmu: Path) -> None:
    with zipfile.ZipFile(fmu) as archive:
        names = set(archive.namelist())
        page = archive.read("documentation/index.html").decode()
        icon = archive.read("model.png")
        licence = archive.read("documentation/licenses/license.txt")
    assert icon.startswith(b"\x89PNG") and licence == b"MIT"
    binaries = {f"binaries/{system}/Spring.{end}" for system, end in BINARIES.items()}
    assert {name for name in names if name.startswith("binaries/")} == binaries
    assert not any(name.endswith(("build.py", "page.py")) and "/fmi/" in name for name in names)
    assert "0.1 to 10" in page and "&lt;&#34;toy&#34;&gt;" in page and "pip install pydantic" in page


def test_simulates_to_the_last_bit_as_without_fmu(fmu: Path) -> None:
    result = simulate_fmu(str(fmu), stop_time=1.0, step_size=0.01, output_interval=0.01)
    assert result["time"][-1] == pytest.approx(1.0, abs=1e-12)
    # fmpy's own times differ from ours in the last digits, and so do the steps
    assert result["place[1]"][-1] == pytest.approx(direct(100).place, rel=1e-12)
    assert result["turns"][-1] == 33


def test_state_goes_on_bit_for_bit_in_another_process(fmu: Path) -> None:
    saved = hosted("save", fmu)
    loaded = hosted("load", fmu, stdin=told(saved, "STATE")[0])
    assert told(loaded, "VALUE") == [told(saved, "VALUE")[0] + f" {1.0 / 3.0} 0.7"]


def test_state_of_another_build_is_refused(fmu: Path, other_build: Path) -> None:
    state = told(hosted("save", fmu), "STATE")[0]
    command = [sys.executable, str(TOYS / "host.py"), "load", str(other_build)]
    result = subprocess.run(command, input=state, capture_output=True, text=True, check=False)
    assert "only states of Spring of comprope_spring_" in result.stdout
    assert result.returncode == 1  # the host's own exception, no crash


def test_fmus_of_the_same_code_live_side_by_side(fmu: Path, tmp_path: Path) -> None:
    """They differ in their GUID only, as with other files inside or another description."""
    twin = build(interface(0.25), ["spring"], ENTRY, tmp_path, Origin("1.2.4", "MIT"), root=TOYS)
    assert read_model_description(str(twin)).guid != read_model_description(str(fmu)).guid
    assert told(hosted("together", fmu, twin, fmu), "VALUE") == [f"spring {direct(9).place!r}"] * 3


@pytest.mark.parametrize("order", [1, -1])
def test_builds_never_mix(fmu: Path, other_build: Path, order: int) -> None:
    pairs = [(fmu, "spring"), (other_build, "other"), (fmu, "spring")][::order]
    result = hosted("together", *(path for path, _ in pairs))
    assert told(result, "VALUE") == [f"{word} {direct(9).place!r}" for _, word in pairs]


def test_hundreds_of_instances_leave_no_trace(fmu: Path, tmp_path: Path) -> None:
    folder = extract(str(fmu), unzipdir=str(tmp_path / "unpacked"))
    result = hosted("many", folder)
    assert told(result, "PATHS") == ["0"]
    assert told(result, "REFERENCES") == ["1"]


def test_a_state_saved_in_place_of_another_takes_its_memory(fmu: Path) -> None:
    result = hosted("saved_often", fmu)
    assert told(result, "HANDLES") == ["1"] and told(result, "VALUE") == [repr(direct(9).place)]


RANGES = (
    "parameter spring.mass = -3 kg: 0.1 to 10 kg is accepted (mass); "
    "parameter spring.stiffness = 1e+09 N/m: 0.1 to 1e+06 N/m is accepted (stiffness)"
)
BROKEN = "no steps and outputs after an error, unless reset or restored; the error was: "


@pytest.mark.parametrize(
    ("scenario", "sentence", "statuses"),
    [
        ("parameters", f"Spring 'one' at t = 0 s: {RANGES}", ERROR),
        ("refused_by_model", "spring.mass = 2.0: must differ from the stiffness; so says the toy", ERROR),
        ("fixed", "parameter spring.mass = 3.0: fixed once the run has started; reset the FMU to change it", ERROR),
        ("nan", "Spring 'one' at t = 0.05 s: input force = nan: a finite number is accepted", ERROR),
        ("diverging", "the spring broke at node 3 at t = 0.06 s", ERROR * 4),
        ("internal", "ZeroDivisionError in step, cosimulation.py:27: float division by zero", ERROR * 4),
        ("not_finite", "the model gave place[1] = nan; the step is too large or the model unstable", ERROR * 4),
        ("times", "step from 0.5 s: the time reached is 0.0 s, and only a step from there is accepted", ERROR * 5),
        ("interrupted", "Spring 'one' at t = 0 s: interrupted", ERROR),
        ("foreign_state", "saved state: 11 bytes that are not a whole state of this FMU", ERROR),
    ],
)
@pytest.mark.parametrize("logging", [False, True])
def test_errors_are_told_and_survived(fmu: Path, scenario: str, sentence: str, statuses: str, logging: bool) -> None:
    result = hosted(scenario, fmu, logging=logging)
    assert told(result, "STATUS") == list(statuses)
    assert sentence in result.stdout and result.stderr == ""  # errors go to the importer's log, whatever is switched off


def test_reset_equals_a_fresh_instance(fmu: Path) -> None:
    assert told(hosted("parameters", fmu), "VALUE") == [f"2.0 {direct(3).place!r}"]


def test_a_failed_run_can_be_taken_back(fmu: Path) -> None:
    assert told(hosted("diverging", fmu), "VALUE") == [f"0.0 {direct(8).place!r}"]


def test_a_refused_value_leaves_the_old_one(fmu: Path) -> None:
    assert told(hosted("nan", fmu), "VALUE") == ["0.0"]
    assert told(hosted("fixed", fmu), "VALUE") == ["2.0"]


def test_a_missing_package_is_named(fmu: Path) -> None:
    result = hosted("without_package", fmu)
    assert told(result, "REFUSED") == ["Failed to instantiate model"]
    assert "Spring cannot be loaded: ModuleNotFoundError: import of pydantic halted" in result.stdout
    assert "pip install pydantic" in result.stdout


def test_outputs_depend_on_inputs_as_declared(fmu: Path) -> None:
    description = read_model_description(str(fmu))
    assert [unknown.dependencies for unknown in description.outputs] == [[]] * 4
    assert [unknown.variable.name for unknown in description.initialUnknowns] == ["place[1]", "moving", "turns", "word"]
    at_start = simulate_fmu(str(fmu), start_values={"force": 0.3}, stop_time=0.01)["place[1]"][0]
    assert at_start == direct(0, force=0.3).place  # at the start, unlike later, the output follows the input


FOLDERS = (
    "plain", "with space", "aufzüge", "лифт", "升降机", "🛗", "a#b", "a+b", "a%b", "a%20b", "a%41b", "[a]", "a&b=c", "it's",
    "a;b", "a@b,c", "(a)", "a?b", "a\\b", "~a$HOME",
)  # fmt: skip


@pytest.mark.parametrize("folder", FOLDERS)
def test_a_folder_may_have_any_name(fmu: Path, tmp_path: Path, folder: str) -> None:
    result = hosted("nan", extract(str(fmu), unzipdir=str(tmp_path / folder)))
    assert told(result, "VALUE") == ["0.0"]


RESOURCES = {
    "file:///": "file://{quoted}", "file:/": "file:{quoted}", "localhost": "file://localhost{quoted}", "plain": "{path}",
    "not encoded": "file://{path}", "closing slash": "file://{quoted}/", "none": None, "elsewhere": "file:///nowhere",
}  # fmt: skip


@pytest.mark.parametrize("how", RESOURCES)
@pytest.mark.parametrize("bare", [False, True], ids=["logger", "no callbacks"])
def test_an_importer_may_name_the_folder_in_any_way(fmu: Path, tmp_path: Path, how: str, bare: bool) -> None:
    folder = extract(str(fmu), unzipdir=str(tmp_path / "a ü#%41"))
    form = RESOURCES[how]
    resources = f"{folder}/resources"
    uri = form.format(path=resources, quoted=quote(resources)) if form else "NONE"
    result = hosted("instantiate", folder, uri, *(["bare"] if bare else []))
    assert told(result, "INSTANCE") == ["True"], result.stderr


def test_what_is_no_instance_is_refused_in_one_sentence(fmu: Path, tmp_path: Path) -> None:
    folder = extract(str(fmu), unzipdir=str(tmp_path / "unpacked"))
    result = hosted("refused", folder)
    assert told(result, "INSTANCE") == ["False"] * 4
    assert told(result, "LOG") == [
        "an instance needs a name",
        "an instance needs a name",
        "this FMU is for co-simulation only",
        "the GUID is not this FMU's: resources and modelDescription.xml do not belong together",
    ]


@pytest.mark.skipif(sys.platform != "linux" or not shutil.which("cc"), reason="a host in C is compiled on Linux")
def test_a_host_that_is_not_python_needs_no_preloading(fmu: Path, tmp_path: Path) -> None:
    """It finds the library of the first python3 in the PATH, here that of the tests, with its packages."""
    folder = extract(str(fmu), unzipdir=str(tmp_path / "aufzüge #1"))
    host, guid = tmp_path / "host", read_model_description(folder).guid
    headers = Path(fmpy.__file__).parent / "c-code"
    subprocess.run(["cc", f"-I{headers}", str(TOYS / "host.c"), "-o", str(host), "-ldl"], check=True)
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    if not sysconfig.get_config_var("Py_ENABLE_SHARED"):
        pytest.skip("this Python has no library")
    command = [str(host), f"{folder}/binaries/linux64/Spring.so", guid, f"file://{quote(str(folder))}/resources"]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    assert float(result.stdout) == direct(9).place


@pytest.mark.parametrize("importer", ["libcosimpy", "ecospy"])
def test_other_importers_end_where_fmpy_ends(fmu: Path, importer: str) -> None:
    pytest.importorskip(importer)
    command = [sys.executable, str(TOYS.parent.parent / "benchmarks" / "importers.py"), str(fmu), "--steps", "50"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    line = next(line for line in result.stdout.splitlines() if importer in line)
    assert float(line.split()[4]) < 1e-9, result.stdout
