"""The wheel: it holds all that the program needs, and works outside the repository."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu

ROOT = Path(__file__).parent.parent
SOURCES = {"comprope": ROOT / "fmu_src" / "comprope", "comprope_system": ROOT / "system" / "comprope_system"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built without network from a copy of the sources."""
    pytest.importorskip("setuptools", minversion="77")
    stage = tmp_path_factory.mktemp("wheel")
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, stage)
    for folder in ("fmu_src", "system"):
        shutil.copytree(ROOT / folder, stage / folder, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    build = "from setuptools import build_meta; build_meta.build_wheel('dist')"
    subprocess.run([sys.executable, "-c", build], cwd=stage, check=True, capture_output=True, timeout=120)
    return next((stage / "dist").glob("comprope-*.whl"))


def test_every_file_of_the_packages_is_in_the_wheel(wheel):
    """Presets, templates, styles, scripts, tables, C sources: whatever lies in a package is there for a reason."""
    inside = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    files = {
        f"{package}/{path.relative_to(folder).as_posix()}"
        for package, folder in SOURCES.items()
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert inside == files
    assert {Path(name).suffix for name in files} >= {".py", ".toml", ".html", ".css", ".js", ".csv", ".c", ".h"}


def test_the_wheel_has_licence_and_command(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        assert any(name.endswith(".dist-info/licenses/LICENSE") for name in names)
        commands = archive.read(next(name for name in names if name.endswith("entry_points.txt"))).decode()
    assert "comprope = comprope_system.cli:main" in commands


@pytest.fixture(scope="module")
def site(wheel, tmp_path_factory):
    """The wheel unpacked beside the installed dependencies, as pip would put it there."""
    folder = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def run(site, folder, *arguments):
    """Run the command of the unpacked wheel in a folder; returns what it prints."""
    code = f"import comprope_system.cli as cli; print(cli.__file__); cli.main({list(map(str, arguments))!r})"
    environment = os.environ | {"PYTHONPATH": str(site)}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.splitlines()[0]).is_relative_to(site)
    return done.stdout.splitlines()[1:]


def test_the_wheel_works_from_another_folder(site, tmp_path):
    quick = [
        *("simulate", "tower50", "--set", "rope.element_length=0.2", "--set", "shaft.height=12", "--to", "3", "--time", "2"),
        *("--report", "trip.html", "--out", "trip.csv"),
    ]
    run(site, tmp_path, *quick)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["trip.csv", "trip.html"]


def test_the_wheel_builds_valid_fmus_of_a_model_file(site, tmp_path):
    """The copied preset is a stranger's file here, and the licence inside is that of the package."""
    shutil.copy(SOURCES["comprope_system"] / "presets" / "tower50.toml", tmp_path / "mine.toml")
    quick = ["--set", "rope.element_length=0.2", "--set", "shaft.height=12", "--sensors", "5"]
    told = run(site, tmp_path, "fmu", "mine.toml", *quick, "--ssp", "--out", "made", "--json", "fmus.json")
    names = ["CompensationRope.fmu", "ElevatorDrive.fmu", "Elevator.ssp"]
    assert told[-3:] == [f"written {Path('made') / name}" for name in names]
    assert sorted(path.name for path in (tmp_path / "made").iterdir()) == sorted(names)
    assert [one["file"] for one in json.loads((tmp_path / "fmus.json").read_text())["files"]] == names
    rope = tmp_path / "made" / names[0]
    assert validate_fmu(str(rope)) == validate_fmu(str(tmp_path / "made" / names[1])) == []
    variables = {one.name: one.start for one in read_model_description(str(rope)).modelVariables}
    assert variables["shaft.height"] == "12.0" and "sensors[5].height" in variables and "sensors[6].height" not in variables
    with zipfile.ZipFile(rope) as archive:
        assert archive.read("documentation/licenses/license.txt") == (ROOT / "LICENSE").read_bytes()
