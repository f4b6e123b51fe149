"""The documentation: what is generated is up to date, what can be run runs, what is linked is there."""

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from playwright.sync_api import expect
from typer.main import get_command

import comprope.effect
import comprope_system
from comprope.rope.effects import INSTRUMENT, REGISTRY
from comprope_system import cli

from .browser_pages import needs_chromium, opened

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
PAGES = sorted([*DOCS.glob("**/*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"])


def anchors(page: Path) -> set[str]:
    """The links that a page's headings can be reached by, as GitHub makes them."""
    titles = re.findall(r"^#+ (.*)$", page.read_text("utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def test_the_reference_is_what_the_declarations_say():
    text = runpy.run_path(str(DOCS / "build_reference.py"))["text"]()
    assert (DOCS / "reference.md").read_text("utf-8") == text, "run `python docs/build_reference.py`"
    assert [name for name in comprope_system.__all__ if not re.search(rf"^### `{name}\b", text, re.MULTILINE)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\((?!https?:)([^)\s]+)\)", page.read_text("utf-8")):
        path, _, anchor = target.partition("#")
        there = page.parent / path if path else page
        assert there.exists(), f"{page.name}: {target}"
        assert not anchor or there.suffix != ".md" or anchor in anchors(there), f"{page.name}: {target}"


def test_every_page_can_be_reached_from_the_first():
    first = (DOCS / "README.md").read_text("utf-8")
    pages = {path.name for path in [*DOCS.glob("*.md"), DOCS / "tutorial.py"]} - {"README.md"}
    assert {name for name in pages if f"({name})" in first} == pages


def test_theory_has_a_line_for_every_effect():
    text = (DOCS / "theory.md").read_text("utf-8")
    effects = [name for name, effect in REGISTRY.items() if not effect.source]
    assert [name for name in (*effects, *INSTRUMENT) if f"`{name}`" not in text] == []


def test_commands_and_options_that_pages_name_exist():
    commands = get_command(cli.app).commands
    known = {name: {"--help", *(text for one in command.params for text in one.opts)} for name, command in commands.items()}
    named: dict[str, set[str]] = {}
    for page in [*PAGES, DOCS / "tutorial.py"]:
        for command, rest in re.findall(r"comprope (?:--allow-code )?([a-z]+) ([^`\n]*)", page.read_text("utf-8")):
            if command in known or "--" in rest:
                named.setdefault(command, set()).update(re.findall(r"(?<!\S)--[a-z][a-z0-9-]*", rest))
    assert set(named) <= set(known)
    assert {"simulate", "compare", "diagnose", "add", "improve", "tune"} <= set(named)
    for command, options in named.items():
        assert options <= known[command], command


# -- the site ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The pages as a reader builds them; a link or an anchor that leads nowhere, and any other warning, stops it."""
    pytest.importorskip("mkdocs")
    out = tmp_path_factory.mktemp("site")
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1"}  # an advertisement, which is no warning of the build
    # Not `--quiet`: it hides warnings, from `--strict` as well.
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", out]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


def test_the_site_has_every_public_name_of_the_python_interfaces(site):
    for module, page in ((comprope_system, "comprope_system.html"), (comprope.effect, "effect.html")):
        text = (site / "api" / page).read_text("utf-8")
        headings = set(re.findall(r'<h[23] id="([\w.]+)"', text))
        assert {f"{module.__name__}.{name}" for name in module.__all__} <= headings


def test_the_site_has_no_markdown_left_in_its_text(site):
    for page in site.rglob("*.html"):
        text = re.sub(r"<(pre|code)\b.*?</\1>", "", page.read_text("utf-8"), flags=re.DOTALL)
        assert re.findall(r"\n\|.*\||\n(?:- |\d\. |#+ |:::).*|.*\]\(.*|.*\*\*\w.*", text) == [], page.name


@needs_chromium
@pytest.mark.parametrize("width", [1400, 700])
def test_pages_of_the_site_fit_the_window_and_load_nothing_from_elsewhere(site, width):
    with opened((site / "index.html").as_uri(), width) as page:
        for name in ("index", "measurements", "theory", "reference", "api/comprope_system", "benchmarks/RESULTS"):
            page.goto((site / f"{name}.html").as_uri())
            assert page.locator("h1").count() == 1, name
            assert page.evaluate("document.documentElement.scrollWidth") <= width, name


@needs_chromium
@pytest.mark.parametrize("page", ["index", "api/comprope_system"])
def test_the_site_is_searched_from_files_without_a_server(site, page):
    with opened((site / f"{page}.html").as_uri()) as shown:
        shown.get_by_role("textbox", name="Search").fill("capstan")
        found = shown.locator(".md-search-result__item a").first
        expect(found).to_be_visible()
        found.click()
        expect(shown).not_to_have_url((site / f"{page}.html").as_uri())
        expect(shown.locator("article")).to_contain_text("capstan")


# -- scripts -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def dist(tmp_path_factory):
    """Both FMUs as a reader of the pages builds them."""
    out = tmp_path_factory.mktemp("dist")
    subprocess.run([sys.executable, ROOT / "build_fmu.py", "--out", out], capture_output=True, check=True)
    return out


def test_the_script_for_fmpy_does_what_simulate_does(dist, tmp_path):
    arguments = [dist / "ElevatorDrive.fmu", dist / "CompensationRope.fmu", tmp_path / "trip.csv", "3"]
    subprocess.run([sys.executable, DOCS / "fmpy_trip.py", *arguments], check=True, timeout=120)
    with pytest.raises(SystemExit):
        cli.main(["simulate", "tower50", "--direct", "--time", "3", "--out", str(tmp_path / "same.csv")])
    one, two = pd.read_csv(tmp_path / "trip.csv"), pd.read_csv(tmp_path / "same.csv")
    assert one["car_position"].iloc[-1] > 0.5
    # The same numbers but for the nine digits that the second file has.
    assert np.allclose(one["lateral_displacement[1]"], two["cw_low"], rtol=1e-8, atol=0.0)
    assert np.allclose(one["sheave_force"], two["sheave_force"], rtol=1e-8, atol=0.0)


def test_the_lines_for_fmpy_on_the_page_run(dist):
    lines = re.search(r"```python\n(.*?)```", (DOCS / "fmu.md").read_text("utf-8"), re.DOTALL)[1]
    found: dict = {}
    exec(lines.replace("dist/", f"{dist.as_posix()}/").replace("stop_time=19.0", "stop_time=3.0"), found)
    result = found["result"]
    assert result["time"][-1] == pytest.approx(3.0)
    assert np.ptp(result["lateral_displacement[1]"]) > 1e-4


@pytest.mark.slow
def test_the_tutorial_runs(tmp_path):
    """In a folder of its own, as a reader runs it; its own assertions say whether it comes out as it tells."""
    done = subprocess.run(
        [sys.executable, DOCS / "tutorial.py"], cwd=tmp_path, env=os.environ | {"MPLBACKEND": "agg"},
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
