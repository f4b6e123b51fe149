"""The pictures of the README are those that a command makes now."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from .browser_pages import needs_chromium

ROOT = Path(__file__).parent.parent
COMMAND = ROOT / "benchmarks" / "readme_pictures.py"
BLOCK, LEVEL = 8, 24  # pixels of a block, and grey levels by which its mean may differ: fonts and rounding differ by less
SHARE = 0.01  # of the blocks that may differ by more; a table with other numbers or other curves differ in several per cent


def differing(first: Path, second: Path) -> float:
    """The share of the blocks of two pictures whose grey levels differ; all of them for pictures of other sizes."""
    with Image.open(first) as one, Image.open(second) as other:
        if max(abs(a - b) for a, b in zip(one.size, other.size, strict=True)) > 2:
            return 1.0
        size = (one.width // BLOCK, one.height // BLOCK)
        a, b = (np.asarray(image.convert("L").resize(size, Image.Resampling.BOX), float) for image in (one, other))
    return float(np.mean(np.abs(a - b) > LEVEL))


def test_the_trip_of_the_readme_is_what_the_command_makes(tmp_path):
    subprocess.run([sys.executable, COMMAND, "--only", "trip", "--out", tmp_path], check=True)
    assert differing(tmp_path / "trip.png", ROOT / "docs" / "trip.png") < SHARE


@pytest.mark.slow
@needs_chromium
def test_the_pages_of_the_readme_are_what_the_command_makes(tmp_path):
    subprocess.run([sys.executable, COMMAND, "--only", "compare", "diagnose", "--out", tmp_path], check=True)
    for name in ("compare", "diagnose", "try"):
        assert differing(tmp_path / "pages" / f"{name}.png", ROOT / "docs" / "pages" / f"{name}.png") < SHARE, name


def test_another_picture_is_not_taken_for_the_same():
    pages = ROOT / "docs" / "pages"
    assert differing(pages / "compare.png", pages / "diagnose.png") > 5 * SHARE
    assert differing(pages / "first_before.png", pages / "first_after.png") > 2 * SHARE
