"""What `comprope modes` does: compute, print, draw and write natural periods and shapes."""

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from comprope.atomic_files import atomic_write, require_writable
from comprope.errors import InputError
from comprope.rope.model_file import load, with_changes
from comprope.rope.parameters import Base

from ..presets import model_path
from ..presets.overrides import assignments
from ..report.plot_style import COLOURS, label, legend, panels
from .hanging_string import side_string
from .modes import Mode, Modes, modes

SHOWN = 6  # shapes in the picture


@dataclass(frozen=True)
class Request:
    """Model, height of the car [m], number of modes, changes KEY=VALUE, and files to write."""

    model: str
    car: float
    count: int
    changes: tuple[str, ...] = ()
    plot: Path | None = None
    json: Path | None = None


def run(request: Request) -> Modes:
    """Compute the modes, print a table and write what is asked for; raises `InputError` for bad input."""
    for path, kind in ((request.plot, "picture"), (request.json, None)):
        if path:
            require_writable(path, kind)
    model = with_changes(load(model_path(request.model)), assignments(request.changes), "--set")
    if not 0.0 <= request.car <= model.shaft.height:
        raise InputError(f"--car {request.car:g}: 0 to shaft.height = {model.shaft.height:g} m is accepted")
    found = modes(model, request.car, request.count)
    sys.stdout.write("".join(f"{line}\n" for line in _lines(model, found)))
    if request.json:
        with atomic_write(request.json) as temporary:
            temporary.write_text(json.dumps(as_json(model, found)), encoding="utf-8")
    if request.plot:
        with atomic_write(request.plot) as temporary:
            draw(found).savefig(temporary, dpi=150)
    return found


def estimate(model: Base, car: float, mode: Mode) -> float | None:
    """The hanging string's period [s] for a lateral mode."""
    return side_string(model, car, mode.place).period(mode.half_waves) if mode.half_waves else None


def as_json(model: Base, found: Modes) -> dict[str, Any]:
    """Periods [s], frequencies [Hz] and shapes; heights [m] are those of the shapes' points."""
    points = slice(None, None, max(1, len(found.heights) // 400))
    return {
        "car_position": found.car,
        "heights": found.heights[points].tolist(),
        "modes": [
            {
                "period": mode.period, "frequency": mode.frequency, "place": mode.place, "half_waves": mode.half_waves,
                "string_period": estimate(model, found.car, mode), "lateral_shape": mode.shape[:-1, 1][points].tolist(),
            }
            for mode in found.modes
        ],
    }  # fmt: skip


def _lines(model: Base, found: Modes) -> list[str]:
    lines = [f"{'period [s]':>11}  {'frequency [Hz]':>14}  {'place':<14}  {'half waves':>10}  {'string [s]':>10}"]
    for mode in found.modes:
        string = estimate(model, found.car, mode)
        waves, text = (str(mode.half_waves), f"{string:.4f}") if string else ("", "")
        lines.append(f"{mode.period:11.4f}  {mode.frequency:14.4f}  {mode.place:<14}  {waves:>10}  {text:>10}")
    return lines


def draw(found: Modes) -> Figure:
    """Shapes of the slowest lateral modes, car's side on the left."""
    figure, axes = panels(2, height=4.2)
    lowest = int(np.argmin(found.heights))
    sides = {"car": slice(0, lowest), "counterweight": slice(lowest, None)}
    for one, (side, nodes) in zip(axes, sides.items(), strict=True):
        shown = [mode for mode in found.modes if mode.place in (side, "both")][:SHOWN]
        for k, mode in enumerate(shown):
            one.plot(mode.shape[:-1, 1][nodes], found.heights[nodes], color=COLOURS[k], label=f"{mode.period:.3f} s")
        label(one, "lateral displacement, largest 1", "height [m]", f"{side}'s side, car at {found.car:g} m")
        if shown:
            legend(one, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure
