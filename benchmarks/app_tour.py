"""The tour of the app: pictures with a caption each, played one after the other as one animated picture."""

import io
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont
from playwright.sync_api import Page

WIDTH, CAPTION = 860, 44  # of the picture and of the band below it, in pixels
FONT = 19  # of the caption, in pixels
COLOURS = 64  # of each frame: pages are flat, and fewer colours are smaller without being blurred
BAND, INK = "#0b4f8a", "#ffffff"


class Tour:
    """Frames of a page with their captions and seconds."""

    def __init__(self, page: Page) -> None:
        self.page, self.frames, self.seconds = page, list[Image.Image](), list[float]()

    def show(self, caption: str, seconds: float, settle: float = 0.5) -> None:
        """Add what is visible now, after some seconds in which it settles."""
        self.page.wait_for_timeout(1e3 * settle)
        with Image.open(io.BytesIO(self.page.screenshot())) as shot:
            height = round(shot.height * WIDTH / shot.width)
            small = shot.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
        frame = Image.new("RGB", (WIDTH, height + CAPTION), BAND)
        frame.paste(small)
        ImageDraw.Draw(frame).text(
            (WIDTH // 2, height + CAPTION // 2), caption, INK, ImageFont.load_default(FONT), anchor="mm"
        )
        self.frames.append(frame)
        self.seconds.append(seconds)

    def save(self, path: Path) -> None:
        """Write the animated picture and print its duration and size."""
        first, *others = (one.quantize(COLOURS).convert("RGB") for one in self.frames)
        times = [round(1e3 * one) for one in self.seconds]
        first.save(path, save_all=True, append_images=others, duration=times, loop=0, lossless=True, method=6, minimize_size=True)
        print(f"tour: {sum(self.seconds):.0f} s, {len(self.frames)} frames, {path.stat().st_size / 1e6:.2f} MB", flush=True)
