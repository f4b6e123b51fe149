"""The whole way in the app with times, from raw files to downloaded FMUs; makes the pictures docs/pages/app_*.png anew.

    python benchmarks/app.py FILE... [--mass RUN.csv=60 ...] [--out docs]

FILES are raw files of a logger and a model file; --mass states the mass of the sheave in a run, whose inertia is in proportion.
Drives the app in Chromium as a person would. Printed: seconds of each step, and milliseconds from the movement of a slider to the
drawn frame (median and 95 % of 100 movements).
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from pages import BROWSER, COLOURS, DOCS, frame_times
from PIL import Image
from playwright.sync_api import Page, expect, sync_playwright

WIDTH, HEIGHT = 1000, 900  # of the pictures, in pixels
PATIENCE = 1_200_000.0  # ms for a computation


class Way:
    """A page of the app, the times of its steps, and where its pictures go."""

    def __init__(self, page: Page, out: Path) -> None:
        self.page, self.out, self.begin = page, out, time.perf_counter()

    def took(self, step: str) -> None:
        """Print the seconds since the last step."""
        now = time.perf_counter()
        print(f"| {step} | {now - self.begin:.1f} s |", flush=True)
        self.begin = now

    def picture(self, name: str) -> None:
        """The visible part of the page as a PNG file of few colours."""
        shot = self.out / "pages" / f"app_{name}.png"
        self.page.wait_for_timeout(700)
        self.page.screenshot(path=shot)
        with Image.open(shot) as image:
            image.convert("RGB").quantize(COLOURS).save(shot, optimize=True)
        self.begin = time.perf_counter()

    def step(self, name: str) -> None:
        """Go to a step."""
        self.page.get_by_role("tab", name=name).click()


def data(way: Way, files: list[str], masses: dict[str, float]) -> None:
    """Drop files, correct the sheaves, save and check."""
    page = way.page
    page.locator("#files").set_input_files(files)
    expect(page.locator("#preview")).to_be_visible(timeout=PATIENCE)
    way.took("files read and described")
    for file, mass in masses.items():
        page.get_by_label(f"mass of the sheave in {file}").fill(f"{mass:g}")
        page.get_by_label(f"mass of the sheave in {file}").press("Tab")
        page.wait_for_timeout(400)
        expect(page.locator("#save")).to_be_enabled(timeout=PATIENCE)
    way.took(f"{len(masses)} corrections")
    page.locator("#columns").scroll_into_view_if_needed()
    way.picture("data")
    page.locator("#save").click()
    page.locator("[data-run=check]").click()
    expect(page.frame_locator("[data-report=check]").locator("h1")).to_be_visible(timeout=PATIENCE)
    way.took("saved and checked")


def compare_and_diagnose(way: Way) -> None:
    """Compare, diagnose, move the effect, and simulate what it was moved to."""
    page = way.page
    way.step("Compare")
    page.locator("[data-run=compare]").click()
    expect(page.frame_locator("[data-report=compare]").locator("h1")).to_be_visible(timeout=PATIENCE)
    way.took("compared")
    way.picture("compare")
    way.step("Diagnose")
    page.locator("[data-job=diagnose]").click()
    expect(page.locator("#job")).to_contain_text("several sizes", timeout=PATIENCE)
    begin, before = way.begin, time.perf_counter()
    way.picture("progress")
    way.begin = begin + time.perf_counter() - before
    report = page.frame_locator("[data-report=diagnose]")
    expect(report.locator(".card")).to_be_visible(timeout=PATIENCE)
    way.took("diagnosed")
    frame = next(one for one in page.frames if "/report/diagnose" in one.url)
    print(f"| from a slider to the frame | {frame_times(frame)} |", flush=True)
    slider = report.locator(".slider input").first
    slider.scroll_into_view_if_needed()
    way.begin = time.perf_counter()
    slider.press("ArrowLeft")
    expect(page.locator("#replayed")).to_contain_text("are simulated", timeout=PATIENCE)
    way.took("simulated on release")
    for _ in range(40):
        slider.press("ArrowLeft")
    way.picture("try")


def take_away(way: Way, folder: Path) -> None:
    """Add the effect of the verdict, build and download the FMUs."""
    page = way.page
    way.step("Add")
    page.locator("[data-job=add]").click()
    expect(page.locator("#variant")).to_be_visible(timeout=PATIENCE)
    way.took("effect added")
    way.picture("add")
    way.step("Take")
    page.get_by_role("button", name="Build the FMUs").click()
    for name in ("CompensationRope.fmu", "ElevatorDrive.fmu", "model.toml"):
        link = page.get_by_role("link", name=name)
        expect(link).to_be_visible(timeout=PATIENCE)
        with page.expect_download() as download:
            link.click()
        download.value.save_as(folder / name)
    way.took("FMUs built and downloaded")
    way.picture("take")


def main() -> None:
    """Go the way."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--mass", nargs="+", default=[])
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    masses = {file: float(mass) for file, mass in (one.split("=") for one in given.mass)}
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        words = [sys.executable, "-m", "comprope_system.cli", "app", "campaign", "--no-browser"]
        server = subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, text=True)
        assert server.stdout
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        page.goto(server.stdout.readline().strip())
        begin, way = time.perf_counter(), Way(page, given.out)
        data(way, given.files, masses)
        compare_and_diagnose(way)
        take_away(way, Path(folder))
        print(f"| all | {time.perf_counter() - begin:.0f} s |", flush=True)
        browser.close()
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
