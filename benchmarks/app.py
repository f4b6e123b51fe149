"""The whole way in the app with times, from raw files to downloaded FMUs; makes the pictures docs/pages/app_* anew.

    python benchmarks/app.py FILE... [--mass RUN.csv=60 ...] [--out docs]

FILES are raw files of a logger and a model file; --mass states the mass of the sheave in a run, whose inertia is in proportion.
Drives the app in Chromium as a person would. Printed: seconds of each step, and milliseconds from the movement of a slider to the
drawn frame (median and 95 % of 100 movements). Pictures are taken between the steps, the tour docs/pages/app_tour.webp as well.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from app_tour import Tour
from pages import BROWSER, COLOURS, DOCS, frame_times
from PIL import Image
from playwright.sync_api import Locator, Page, expect, sync_playwright

WIDTH, HEIGHT = 1000, 900  # of the pictures, in pixels
PATIENCE = 1_800_000.0  # ms for a computation
DRAGGED = 24  # positions of a slider that the tour shows


class Way:
    """A page of the app, the times of its steps, and where its pictures go."""

    def __init__(self, page: Page, out: Path) -> None:
        self.page, self.out, self.begin, self.total = page, out, time.perf_counter(), 0.0
        self.tour = Tour(page)

    def took(self, step: str) -> None:
        """Print the seconds since the last step."""
        now = time.perf_counter()
        print(f"| {step} | {now - self.begin:.1f} s |", flush=True)
        self.total += now - self.begin
        self.begin = now

    def show(self, caption: str, seconds: float, name: str = "", settle: float = 0.7) -> None:
        """Add to the tour, and write a picture of few colours if it has a name; takes no time of the way."""
        self.tour.show(caption, seconds, settle)
        if name:
            shot = self.out / "pages" / f"app_{name}.png"
            self.page.screenshot(path=shot)
            with Image.open(shot) as image:
                image.convert("RGB").quantize(COLOURS).save(shot, optimize=True)
        self.begin = time.perf_counter()

    def step(self, name: str) -> None:
        """Go to a step."""
        self.page.get_by_role("tab", name=name).click()

    def top(self, what: Locator, above: int = 8) -> None:
        """Scroll until something is at the top of the window."""
        self.page.wait_for_timeout(200)
        box = what.bounding_box()
        assert box
        self.page.mouse.wheel(0, box["y"] - above)
        self.page.wait_for_timeout(300)


def data(way: Way, files: list[str], masses: dict[str, float]) -> None:
    """Drop files, correct the sheaves, save and check."""
    page = way.page
    way.show("1  Data: drop the files of the logger", 5)
    page.locator("#files").set_input_files(files)
    expect(page.locator("#preview")).to_be_visible(timeout=PATIENCE)
    way.took("files read and described")
    way.show("What each column is taken for, and how surely", 7)
    for file, mass in masses.items():
        page.get_by_label(f"mass of the sheave in {file}").fill(f"{mass:g}")
        page.get_by_label(f"mass of the sheave in {file}").press("Tab")
        page.wait_for_timeout(400)
        expect(page.locator("#save")).to_be_enabled(timeout=PATIENCE)
    way.took(f"{len(masses)} corrections")
    way.top(page.locator("#columns"), 60)
    way.show("Correct what is wrong: here the sheave of two trips", 6, "data")
    page.locator("#save").click()
    page.locator("[data-run=check]").click()
    expect(page.frame_locator("[data-report=check]").locator("h1")).to_be_visible(timeout=PATIENCE)
    way.took("saved and checked")
    way.show("2  Check: can all of it be used?", 4)


def compare(way: Way) -> None:
    """Compare, and go from a cell of the map to its curves."""
    page = way.page
    way.step("Compare")
    page.locator("[data-run=compare]").click()
    report = page.frame_locator("[data-report=compare]")
    expect(report.locator("h1")).to_be_visible(timeout=PATIENCE)
    way.took("compared")
    way.show("3  Compare: where the model fails most, by run, channel and phase", 8, "compare")
    report.locator(".heat .heat5 a, .heat .heat4 a").last.click()
    way.show("A click leads to the curves: measured, model, residual", 6)


def diagnose(way: Way) -> None:
    """Diagnose, move the effect, and simulate what it was moved to."""
    page = way.page
    page.mouse.wheel(0, -20_000)
    way.step("Diagnose")
    page.locator("[data-job=diagnose]").click()
    way.begin = time.perf_counter()
    for pattern, name in (("several sizes", "progress"), ("full model", ""), ("full mesh", "")):
        expect(page.locator("#job")).to_contain_text(pattern, timeout=PATIENCE)
        begin, before = way.begin, time.perf_counter()
        way.show("4  Diagnose: which effect is missing? It may be closed and resumed", 3, name)
        way.begin = begin + time.perf_counter() - before
    report = page.frame_locator("[data-report=diagnose]")
    expect(report.locator(".card")).to_be_visible(timeout=PATIENCE)
    way.took("diagnosed")
    way.top(report.locator("#verdict"))
    way.show("The verdict: what, how large, how surely, and where it shows", 9, "verdict")
    frame = next(one for one in page.frames if "/report/diagnose" in one.url)
    print(f"| from a slider to the frame | {frame_times(frame)} |", flush=True)
    _try(way, report.locator(".slider input").first, report)


def _try(way: Way, slider: Locator, report: Any) -> None:
    """Drag the slider from nothing to the fit and beyond, pin a setting, and wait for the simulation."""
    page = way.page
    way.top(report.locator("#try"))
    low, high = (float(slider.get_attribute(name) or 0.0) for name in ("min", "max"))
    moved = "(one, value) => { one.value = value; one.dispatchEvent(new Event('input')); }"
    for k in range(DRAGGED + 1):
        slider.evaluate(moved, low + (high - low) * k / DRAGGED)
        if k == DRAGGED // 3:
            report.locator(".preview .pin").click()
        way.show("Try it: curves and errors follow the hand", 0.4, settle=0.05)
    slider.evaluate(moved, low + 0.45 * (high - low))
    way.begin = time.perf_counter()
    slider.press("ArrowLeft")
    expect(page.locator(".replayed[data-source=diagnose]")).to_contain_text("are simulated", timeout=PATIENCE)
    way.took("simulated on release")
    way.show("Released, it is simulated: preview becomes replayed. Settings are pinned", 7, "try")


def better_models(way: Way) -> None:
    """Fit from where the slider is, add the effect of the verdict, and draw both models together."""
    page = way.page
    page.frame_locator("[data-report=diagnose]").locator(".fit").click()
    way.begin = time.perf_counter()
    expect(page.locator("#job")).to_contain_text("fitting", timeout=PATIENCE)
    begin, before = way.begin, time.perf_counter()
    way.show("5  Fit from here", 3)
    way.begin = begin + time.perf_counter() - before
    expect(page.locator("#variants")).to_contain_text(" from ", timeout=PATIENCE)
    way.took("fitted from where the slider was")
    page.locator("[data-job=add]").click()
    expect(page.locator("#variants tbody tr")).to_have_count(3, timeout=PATIENCE)
    way.took("effect added without a start")
    way.show("New models with their intervals: the error has fallen to the noise", 7, "add")
    for tick in page.locator("#variants input").all():
        tick.check()
    way.begin = time.perf_counter()
    page.locator("#overlay").click()
    expect(page.frame_locator("#variant").locator("#models")).to_be_visible(timeout=PATIENCE)
    way.took("models drawn together")
    way.show("Models drawn together over the measurements", 5)


def take_away(way: Way, folder: Path) -> None:
    """Build and download the FMUs."""
    page = way.page
    page.mouse.wheel(0, -20_000)
    way.step("Take")
    page.get_by_role("button", name="Build the FMUs").first.click()
    for name in ("CompensationRope.fmu", "ElevatorDrive.fmu", "model.toml"):
        link = page.get_by_role("link", name=name).first
        expect(link).to_be_visible(timeout=PATIENCE)
        with page.expect_download() as download:
            link.click()
        download.value.save_as(folder / name)
    way.took("FMUs built and downloaded")
    way.show("6  Take away: model, FMUs, reports", 6, "take")
    way.top(page.locator("#commands"), 80)
    way.show("and the commands that do the same", 6)


def main() -> None:
    """Go the way."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--mass", nargs="+", default=[])
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    masses = {file: float(mass) for file, mass in (one.split("=") for one in given.mass)}
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        words = [sys.executable, "-m", "comprope_system.cli", "app", "tower", "--no-browser"]
        server = subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, text=True)
        assert server.stdout
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        page.goto(server.stdout.readline().strip())
        way = Way(page, given.out)
        try:
            data(way, given.files, masses)
            compare(way)
            diagnose(way)
            better_models(way)
            take_away(way, Path(folder))
        finally:
            browser.close()
            server.terminate()
            server.wait()
    print(f"| all | {way.total:.0f} s |", flush=True)
    way.tour.save(given.out / "pages" / "app_tour.webp")


if __name__ == "__main__":
    main()
