"""HTML pages: sections of paragraphs, tables, curves, figures and animations in one file without external resources."""

import base64
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from matplotlib.figure import Figure

from comprope.atomic_files import atomic_write

from .card import Card
from .curves import Curves
from .heat_map import HeatMap
from .preview import Preview

DPI = 130
UPLOT = ("uplot/uPlot.min.css", "curves.css", "uplot/notice.js", "uplot/uPlot.iife.min.js", "curves.js")
PREVIEW = ("preview.css", "pins.js", "preview.js")
NUMBER = re.compile(r"[-−+]?[\d.][\d.e+/-]*( ± [\d.e+-]+)?( [^ \d]+)?")  # or two, with a standard error, with a unit
MARKS = {"yes": "yes", "no": "no", "partly": "partly", "pass": "yes", "fail": "no"}


@dataclass(frozen=True)
class Table:
    """A table of texts; columns of numbers are right-aligned, marks are coloured."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    caption: str = ""

    def numeric(self, column: int) -> bool:
        """Whether a column contains numbers only."""
        cells = [row[column] for row in self.rows]
        return bool(cells) and all(NUMBER.fullmatch(cell) for cell in cells if cell not in ("", "–"))

    def told(self, column: int) -> bool:
        """Whether a column has anything in it; a page leaves out those that have not."""
        return not self.rows or any(row[column] for row in self.rows)

    def mark(self, cell: str) -> str:
        """The CSS class of a cell that is a mark such as "yes" or "fail"; empty for any other."""
        return MARKS.get(cell, "")


@dataclass(frozen=True)
class Picture:
    """A figure with a caption and the name of its file."""

    name: str
    figure: Figure
    caption: str = ""

    @cached_property
    def png(self) -> bytes:
        """The figure as PNG."""
        buffer = io.BytesIO()
        self.figure.savefig(buffer, format="png", dpi=DPI, metadata={"Software": None})
        return buffer.getvalue()

    @cached_property
    def source(self) -> str:
        """The figure as the source of an HTML image."""
        return f"data:image/png;base64,{base64.b64encode(self.png).decode()}"


@dataclass(frozen=True)
class Animation:
    """An animation (see `simulation.animation.encoding.animation_data`) with a name and a caption."""

    name: str
    animation_data: dict[str, Any]
    caption: str = ""


@dataclass(frozen=True)
class Listing:
    """A file's text as it is."""

    listing: str
    caption: str = ""


Block = str | Card | Table | HeatMap | Picture | Curves | Preview | Animation | Listing


@dataclass(frozen=True)
class Section:
    """One section of a page: a name for links, a title, its content, a quotation; `folded` shows the title until it is asked."""

    name: str
    title: str
    blocks: Sequence[Block]
    quote: str = ""
    folded: bool = False


def render(template: str, title: str, lead: str = "", **values: Any) -> str:
    """HTML text of a page from a template of this folder that extends `base.html`, with its styles and scripts."""
    environment = Environment(
        loader=PackageLoader(__name__.rpartition(".")[0], ""),
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    blocks = [block for section in values.get("sections", ()) for block in section.blocks]
    plotted: tuple[str, ...] = UPLOT if any(isinstance(block, (Curves, Preview)) for block in blocks) else ()
    plotted += PREVIEW if any(isinstance(block, Preview) for block in blocks) else ()
    played = ("player.js",) if any(isinstance(block, Animation) for block in blocks) else ()
    page = {
        "title": title, "lead": lead, "version": _version(),
        "styles": _texts("style.css", *(name for name in plotted if name.endswith(".css"))),
        "scripts": _texts(*(name for name in plotted if name.endswith(".js")), *played),
    }  # fmt: skip
    return environment.get_template(template).render(page | values)


def _texts(*names: str) -> list[str]:
    """Files of this folder."""
    return [(Path(__file__).parent / name).read_text(encoding="utf-8") for name in names]


def save_page(path: str | Path, title: str, lead: str, sections: Sequence[Section]) -> None:
    """Write a page of sections, completely or not at all."""
    with atomic_write(path) as temporary:
        temporary.write_text(render("sections.html", title, lead, sections=sections), encoding="utf-8")


def save_pictures(folder: Path, sections: Sequence[Section]) -> list[Path]:
    """Write every picture of the sections into a folder as a PNG file; returns their paths."""
    paths = []
    for picture in (block for section in sections for block in section.blocks if isinstance(block, Picture)):
        paths.append(folder / f"{picture.name}.png")
        with atomic_write(paths[-1]) as temporary:
            temporary.write_bytes(picture.png)
    return paths


def _version() -> str:
    try:
        return version("comprope")
    except PackageNotFoundError:
        return ""
