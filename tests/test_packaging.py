"""The wheel: it holds all that the program needs, and works outside the repository."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

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


def test_the_wheel_works_from_another_folder(wheel, tmp_path):
    """Unpacked beside the installed dependencies, as pip would put it there."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
    here = tmp_path / "elsewhere"
    here.mkdir()
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "site")}
    quick = [
        *("simulate", "tower50", "--set", "rope.element_length=0.2", "--set", "shaft.height=12", "--to", "3", "--time", "2"),
        *("--report", "trip.html", "--out", "trip.csv"),
    ]
    run = f"import comprope_system.cli as cli; print(cli.__file__); cli.main({quick!r})"
    done = subprocess.run(
        [sys.executable, "-c", run], cwd=here, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.splitlines()[0]).is_relative_to(tmp_path / "site")
    assert sorted(path.name for path in here.iterdir()) == ["trip.csv", "trip.html"]
