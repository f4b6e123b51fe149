"""The table of mutants follows the sources, and each mutant is killed by a test named for it."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "benchmarks"))
from mutants import mutated  # noqa: E402
from mutants_table import MUTANTS  # noqa: E402


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda one: one.name)
def test_a_mutant_changes_one_place_and_its_tests_exist(mutant) -> None:
    file, changed = mutated(mutant, ROOT)
    assert changed != file.read_text(encoding="utf-8")
    compile(changed, file, "exec")
    for test in mutant.tests:
        name, _, function = test.partition("::")
        assert (f"def {function}(" if function else "def test_") in (ROOT / "tests" / name).read_text(encoding="utf-8")


def test_names_are_unique_and_every_part_has_its_mutants() -> None:
    assert len({one.name for one in MUTANTS}) == len(MUTANTS) >= 60
    assert {one.area for one in MUTANTS} >= {
        "mechanics", "integration", "outputs", "units", "whitening", "scores", "drive", "sweep", "sensitivity", "fmi",
    }  # fmt: skip


@pytest.mark.slow
def test_every_mutant_is_killed() -> None:
    """Some minutes: a run of pytest for each."""
    done = subprocess.run([sys.executable, ROOT / "benchmarks" / "mutants.py"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, "\n".join(line for line in done.stdout.splitlines() if line.startswith("NOT KILLED"))
