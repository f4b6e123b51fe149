"""The command that builds the FMUs of this project."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

from comprope.errors import InputError
from comprope.fmi.reference_result import DURATION, INPUT_FILE, OUTPUT_FILE, OUTPUT_INTERVAL, reference_result
from comprope.rope.model_file import load, with_changes
from comprope.rope.simulator.cosimulation import interface
from comprope_system import presets
from comprope_system.simulation.fmu_export.result import FmuResult

ROOT = Path(__file__).parent.parent


def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "build_fmu.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Rope, with six sensors, and drive."""
    out = tmp_path_factory.mktemp("dist")
    result = run("--out", out, "--sensors", "6")
    assert result.returncode == 0, result.stderr
    rope, drive = out / "CompensationRope.fmu", out / "ElevatorDrive.fmu"
    assert result.stdout.splitlines() == [str(rope), str(drive)]
    return rope, drive


def test_both_fmus_are_valid_and_carry_as_many_sensors_as_asked_for(built: tuple[Path, Path]) -> None:
    rope, drive = built
    assert validate_fmu(str(rope)) == validate_fmu(str(drive)) == []
    names = [one.name for one in read_model_description(str(rope)).modelVariables]
    assert sum(name.startswith("lateral_displacement[") for name in names) == 6


@pytest.mark.parametrize("which", [0, 1], ids=["rope", "drive"])
def test_the_reference_result_inside_is_met(built: tuple[Path, Path], which: int, tmp_path: Path) -> None:
    fmu = built[which]
    description = read_model_description(str(fmu))
    with zipfile.ZipFile(fmu) as archive:
        found = [read_csv(archive.extract(name, tmp_path)) for name in (INPUT_FILE, OUTPUT_FILE) if name in archive.namelist()]
    expected, given, step = found[-1], found[0] if len(found) > 1 else None, float(description.defaultExperiment.stepSize)
    names = [name for name in expected.dtype.names if name != "time"]
    nominal = {one.name: float(one.nominal or 1.0) for one in description.modelVariables}
    times = {"stop_time": DURATION, "step_size": step, "output_interval": step}
    made = simulate_fmu(str(fmu), **times, input=given, output=names)[:: round(OUTPUT_INTERVAL / step)]
    for name in names:
        # The file holds nine digits, and fmpy's times differ in their last ones.
        assert made[name] == pytest.approx(expected[name], rel=1e-6, abs=1e-6 * nominal[name]), name


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--model", "absent.toml"), "absent.toml: cannot be read"),
        (("--sensors", "-1"), "sensors = -1: a whole number from 0 to 1000 is accepted"),
    ],
)
def test_bad_input_is_one_line_and_leaves_no_file(tmp_path: Path, arguments: tuple[str, ...], sentence: str) -> None:
    result = run("--out", tmp_path, *arguments)
    assert result.returncode == 2
    assert sentence in result.stderr and len(result.stderr.splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_in_a_low_shaft_the_reference_rises_less() -> None:
    model = with_changes(load(presets.model_path("tower50")), {"shaft.height": 1.0, "rope.element_length": 0.1})
    last = reference_result(interface(model))[INPUT_FILE].decode().splitlines()[-1]
    assert [float(value) for value in last.split(",")] == [4.0, 0.25, 0.75]


def test_files_are_written_all_or_none(tmp_path: Path) -> None:
    """What stands in the way of the second file leaves the first as it was."""
    result = FmuResult({"one.fmu": b"new", "two.fmu": b"new"}, load(presets.model_path("tower50")), "tower50")
    (tmp_path / "one.fmu").write_bytes(b"old")
    (tmp_path / "two.fmu").mkdir()
    with pytest.raises(InputError, match=r"two\.fmu: is a folder"):
        result.save(tmp_path)
    assert (tmp_path / "one.fmu").read_bytes() == b"old" and len(list(tmp_path.iterdir())) == 2
