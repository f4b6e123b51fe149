"""Uniform style of figures."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

FIRST, SECOND, THIRD, FOURTH, GREY = "#0b4f8a", "#d9772b", "#2a8c6e", "#8a3f8f", "#9aa5b1"
COLOURS = (FIRST, SECOND, THIRD, FOURTH, "#b3361b", "#5b7fa6", "#b89b2e", GREY)


def panels(columns: int = 1, rows: int = 1, height: float = 3.6) -> tuple[Figure, Sequence[Axes]]:
    """A figure with its panels, row by row."""
    figure = Figure(figsize=(9.0, height * rows), layout="constrained")
    axes = [figure.add_subplot(rows, columns, k + 1) for k in range(rows * columns)]
    for one in axes:
        one.grid(color="#e6e9ed", linewidth=0.7)
        one.set_axisbelow(True)
        one.spines[["top", "right"]].set_visible(False)
    return figure, axes


def label(axes: Axes, x: str, y: str, title: str = "") -> None:
    """Name both axes, and the panel."""
    axes.set_xlabel(plain(x))
    axes.set_ylabel(plain(y))
    if title:
        axes.set_title(plain(title), loc="left", fontsize=10.5)


def plain(text: str) -> str:
    """A text of the user's files for a figure, in which a dollar sign begins no formula and no control character stands."""
    shown = "".join(character if character.isprintable() else " " for character in text)
    return shown.replace("$", r"\$").removeprefix("_") or " "


def legend(axes: Axes, **options: Any) -> None:
    """The legend, without a frame."""
    axes.legend(frameon=False, fontsize=8.5, **options)


def plain_log(*axes: Axis) -> None:
    """Plain numbers 1, 2, 5, 10 … on logarithmic axes."""
    for axis in axes:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
