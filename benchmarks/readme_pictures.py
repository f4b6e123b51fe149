"""The pictures of the README, made anew from a clean clone: docs/trip.png, and compare, diagnose and try of docs/pages.

    python benchmarks/readme_pictures.py [--only trip compare diagnose] [--campaign FOLDER] [--out docs]

The campaign is simulated by the independent simulator of `benchmarks/plant`, with 22 N m of bearing friction hidden in it, unless
FOLDER has one already; with the diagnosis it takes minutes. The try picture is made with that of the diagnosis. Needs Chromium.
"""

import argparse
import contextlib
import subprocess
import sys
import tempfile
from pathlib import Path

from pages import BROWSER, COLOURS, DOCS, WIDTH, picture
from PIL import Image
from playwright.sync_api import sync_playwright

import comprope_system

CAUSE = ("--cause", "bearing_friction", "--size", "22", "--seed", "5")
NAME = "tower"  # of the campaign's folder, which pages name
TRIED_HEIGHT = 900  # of the picture of the sliders, in pixels
STEPS = 50  # of a slider, from the fit towards nothing


def trip(out: Path) -> None:
    """The plot of the README's first command."""
    comprope_system.simulate("tower50").save_plot(out / "trip.png")


def compare(out: Path) -> None:
    """The page of `comprope compare`, of the campaign in this folder."""
    page = Path("compare.html")
    comprope_system.compare(NAME, previews=True).save_html(page)
    picture(page.resolve(), out / "pages" / "compare.png")


def diagnose(out: Path) -> None:
    """The page of `comprope diagnose`, and its sliders."""
    page = Path("diagnose.html")
    comprope_system.diagnose(NAME, previews=True).save_html(page)
    picture(page.resolve(), out / "pages" / "diagnose.png")
    tried(page.resolve(), out / "pages" / "try.png")


def tried(page: Path, file: Path) -> None:
    """The sliders of a page with a setting pinned."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        shown = browser.new_page(viewport={"width": WIDTH, "height": TRIED_HEIGHT})
        shown.goto(page.as_uri())
        slider = shown.locator(".slider input").first
        for k in range(STEPS):
            slider.press("ArrowLeft")
            if k == STEPS // 2:
                shown.locator(".preview .pin").click()
        shown.locator("#try").evaluate("(one) => window.scrollTo(0, one.offsetTop)")
        shown.wait_for_timeout(300)
        shown.screenshot(path=file)
        browser.close()
    with Image.open(file) as image:
        image.convert("RGB").quantize(COLOURS).save(file, optimize=True)


MAKERS = {"trip": trip, "compare": compare, "diagnose": diagnose}


def main() -> None:
    """Make the pictures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=MAKERS, default=list(MAKERS))
    parser.add_argument("--campaign", type=Path)
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    out, plant = given.out.resolve(), Path(__file__).with_name("plant_campaign.py").resolve()
    (out / "pages").mkdir(parents=True, exist_ok=True)
    campaign = given.campaign and given.campaign.resolve()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        if given.only != ["trip"]:
            if campaign:
                Path(NAME).symlink_to(campaign)
            else:
                subprocess.run([sys.executable, plant, "--out", NAME, *CAUSE], check=True)
        for name in given.only:
            MAKERS[name](out)
            print(f"made {name}", flush=True)


if __name__ == "__main__":
    main()
