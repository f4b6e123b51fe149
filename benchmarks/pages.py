"""Size, time to open, and look of the pages; makes docs/trip.png and the pictures of docs/pages anew.

    python benchmarks/pages.py CAMPAIGN EFFECT [--only trip compare diagnose add design tune] [--out docs]
    python benchmarks/pages.py --measure PAGE.html ... [--out docs]

CAMPAIGN is a folder with campaign.toml, EFFECT the one that `add` adds. Needs Chromium. The time to open is that from the start
of the navigation to the end of the load event, when all curves that are switched on are drawn; the least of three. --measure
measures pages that are there, and shows the last one wide and narrow, light and dark, in docs/pages/looks.png.
"""

import argparse
import contextlib
import io
import itertools
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright

import comprope_system
from comprope_system import DesignOptions, TuningOptions

DOCS = Path(__file__).parent.parent / "docs"
WIDTH, HEIGHT, COLOURS = 1000, 1500, 96  # of a picture in pixels, and of its palette
LOOKS_HEIGHT = 1400  # of a window in pixels
TIMED = """<script>
addEventListener("load", () => setTimeout(() => { document.title = `opened ${performance.now()}`; }));
</script></body>"""
MOVES = 100  # of a slider
MOVE = """async (count) => {
  const figure = document.querySelector("#preview"), input = figure.querySelector(".slider input");
  const [low, high] = [+input.min, +input.max];
  const frame = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  figure.frames = [];
  for (let k = 0; k < count; k += 1) {
    input.value = low + ((high - low) * (k % 50)) / 50;
    input.dispatchEvent(new Event("input"));
    await frame();
  }
  return figure.frames;
}"""
BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "chrome"))), "chromium")


def browser(page: Path, *options: str) -> str:
    """What Chromium prints for a page."""
    words = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--window-size={WIDTH},{HEIGHT}"]
    return subprocess.run([*words, *options, page.as_uri()], capture_output=True, text=True, timeout=120, check=True).stdout


def time_to_open(page: Path) -> float:
    """Seconds from the start of the navigation to the end of the load event."""
    timed = page.with_name(f"{page.stem}_timed.html")
    timed.write_text(page.read_text(encoding="utf-8").replace("</body>", TIMED), encoding="utf-8")
    found = [re.search(r"<title>opened ([\d.]+)", browser(timed, "--timeout=30000", "--dump-dom")) for _ in range(3)]
    return min(float(one[1]) for one in found if one) / 1e3



def looks(page: Path, file: Path) -> None:
    """A page in windows of 1400 and 700 pixels, light and dark, side by side at half their size."""
    shots = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        for width, scheme in itertools.product((1400, 700), ("light", "dark")):
            shown = browser.new_page(viewport={"width": width, "height": LOOKS_HEIGHT}, color_scheme=scheme)
            shown.goto(page.as_uri())
            shown.wait_for_timeout(500)
            with Image.open(io.BytesIO(shown.screenshot())) as shot:
                shots.append(shot.convert("RGB").resize((width // 2, LOOKS_HEIGHT // 2), Image.Resampling.LANCZOS))
        browser.close()
    whole = Image.new("RGB", (sum(one.width for one in shots), LOOKS_HEIGHT // 2))
    for k, one in enumerate(shots):
        whole.paste(one, (sum(other.width for other in shots[:k]), 0))
    whole.save(file, optimize=True)


def frame_times(frame: Any) -> str:
    """Milliseconds from the movement of a slider until its frame has been drawn, of a page in playwright."""
    times = frame.evaluate(MOVE, MOVES)
    return f"median {np.median(times):.0f} ms, 95 % {np.percentile(times, 95):.0f} ms"


def slider_times(page: Path) -> str:
    """The same of a page that has sliders; nothing for others."""
    if 'class="preview"' not in page.read_text(encoding="utf-8"):
        return ""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        shown = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        shown.goto(page.as_uri())
        found = frame_times(shown)
        browser.close()
    return found


def picture(page: Path, file: Path) -> None:
    """The first rows of a page as a PNG file of few colours."""
    shot = page.with_suffix(".png")
    browser(page, "--virtual-time-budget=4000", f"--screenshot={shot}")
    with Image.open(shot) as image:
        image.convert("RGB").quantize(COLOURS).save(file, optimize=True)


def report(name: str, page: Path, out: Path) -> None:
    """Print a row of the table and write the picture."""
    picture(page, out / "pages" / f"{name}.png")
    measured(name, page)


def measured(name: str, page: Path) -> None:
    """Print a row of the table."""
    print(f"| {name} | {page.stat().st_size / 1e6:.2f} MB | {time_to_open(page):.2f} s | {slider_times(page)} |", flush=True)


def makers(campaign: str, effect: str, out: Path) -> dict[str, Callable[[Path], None]]:
    """What writes each page."""

    def trip(page: Path) -> None:
        result = comprope_system.simulate("tower50")
        result.save_html(page)
        result.save_plot(out / "trip.png")

    return {
        "trip": trip,
        "compare": lambda page: comprope_system.compare(campaign, previews=True).save_html(page),
        "diagnose": lambda page: comprope_system.diagnose(campaign, previews=True).save_html(page),
        "add": lambda page: comprope_system.add(campaign, effect).save_html(page),
        "design": lambda page: comprope_system.design("building200", DesignOptions(floors=9)).save_html(page),
        "tune": lambda page: comprope_system.tune("building200", TuningOptions(trips=("0:22",))).save_html(page),
    }


def main() -> None:
    """Make the pages."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("campaign", nargs="?")
    parser.add_argument("effect", nargs="?")
    parser.add_argument("--measure", nargs="+", type=Path)
    parser.add_argument("--only", nargs="+")
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    if given.measure:
        for page in given.measure:
            measured(page.stem, page.resolve())
        looks(given.measure[-1].resolve(), given.out / "pages" / "looks.png")
        return
    if not given.effect:
        parser.error("CAMPAIGN and EFFECT are needed, or --measure")
    campaign, out = Path(given.campaign).resolve(), given.out.resolve()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(campaign.parent):  # pages name the campaign as it is given
        for name, make in makers(campaign.name, given.effect, out).items():
            if not given.only or name in given.only:
                page = Path(folder) / f"{name}.html"
                make(page)
                report(name, page, out)


if __name__ == "__main__":
    main()
