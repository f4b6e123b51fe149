"""The command that builds the FMUs of this project."""

import subprocess
import sys
from pathlib import Path

import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu

ROOT = Path(__file__).parent.parent


def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "build_fmu.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_both_fmus_are_valid_and_carry_as_many_sensors_as_asked_for(tmp_path: Path) -> None:
    result = run("--out", tmp_path, "--sensors", "6")
    assert result.returncode == 0, result.stderr
    rope, drive = tmp_path / "CompensationRope.fmu", tmp_path / "ElevatorDrive.fmu"
    assert result.stdout.splitlines() == [str(rope), str(drive)]
    assert validate_fmu(str(rope)) == validate_fmu(str(drive)) == []
    names = [one.name for one in read_model_description(str(rope)).modelVariables]
    assert sum(name.startswith("lateral_displacement[") for name in names) == 6


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [(("--model", "absent.toml"), "absent.toml: cannot be read"), (("--sensors", "-1"), "--sensors -1: 0 to 1000 is accepted")],
)
def test_bad_input_is_one_line_and_leaves_no_file(tmp_path: Path, arguments: tuple[str, ...], sentence: str) -> None:
    result = run("--out", tmp_path, *arguments)
    assert result.returncode == 2
    assert sentence in result.stderr and len(result.stderr.splitlines()) == 1
    assert not list(tmp_path.iterdir())
