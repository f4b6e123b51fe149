"""Natural periods of the sides against the closed-form solution of a hanging string."""

from typing import Any

import numpy as np

from ...presets.paper_installations import BUILDING, installation
from ...report.comparison_report import ComparisonReport
from ...report.page import Picture, Table
from ...report.plot_style import COLOURS, label, legend, panels
from ...vibration.modal.hanging_string import side_string
from ...vibration.modal.modes import Modes, modes
from .check import Check, pass_or_fail

CAR = 22.0  # m
COUNT = 12
ALLOWED = 1e-3


def _run() -> ComparisonReport:
    model = installation(BUILDING)
    found = modes(model, CAR, COUNT)
    rows = []
    for mode in found.modes:
        if mode.half_waves:
            string = side_string(model, CAR, mode.place)
            rows.append((mode, string.period(mode.half_waves), string.wkb_period(mode.half_waves)))
    worst = max(abs(mode.period / exact - 1.0) for mode, exact, _ in rows)
    comparisons = [
        pass_or_fail(
            "periods of the lateral modes / those of the string",
            f"1 within {100 * ALLOWED:g} %",
            f"within {100 * worst:.3f} %",
            worst < ALLOWED,
        )
    ]
    text = (
        "The 200 m building, car at 22 m, linearised about the static shape, with the rope sticking to a sheave that is free to "
        "rotate and to rise. The string has the tension at the height of the axle and is fixed there; bending stiffness reduces "
        "the periods of higher modes slightly."
    )
    numbers = [
        (
            mode.place,
            f"{mode.half_waves}",
            f"{mode.period:.4f}",
            f"{exact:.4f}",
            f"{wkb:.4f}",
            f"{1e3 * (mode.period / exact - 1.0):+.3f}",
        )
        for mode, exact, wkb in rows
    ]
    head = ("side", "half waves", "model [s]", "string, Bessel [s]", "string, WKB [s]", "model / Bessel - 1 [‰]")
    return ComparisonReport(comparisons, [text, Table(head, numbers), Picture("verify_modes", _draw(found))])


def _draw(found: Modes) -> Any:
    figure, (axes,) = panels(height=3.4)
    shown = [mode for mode in found.modes if mode.place == "counterweight"][:4]
    for k, mode in enumerate(shown):
        lowest = int(np.argmin(found.heights))
        axes.plot(found.heights[lowest:], mode.shape[lowest:-1, 1], color=COLOURS[k], label=f"{mode.period:.2f} s")
    label(axes, "height [m]", "lateral displacement, largest 1", "counterweight's side")
    legend(axes)
    return figure


CHECK = Check("periods", "Closed form: natural periods", _run)
