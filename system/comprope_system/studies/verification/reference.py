"""Comparison with another program: a hanging rope with a free mass, excited laterally at its upper end."""

from pathlib import Path
from typing import Any

import numpy as np

from ...report.comparison_report import ComparisonReport
from ...report.page import Picture, Table
from ...report.plot_style import COLOURS, label, legend, panels
from ...vibration.prescribed_trip import Floats
from .check import Check, pass_or_fail
from .free_rope import Hanging, swing_sideways

SERIES = Path(__file__).with_name("data") / "free_rope.csv"
RUNS = ((250, 1e-3), (500, 1e-3), (1000, 2e-3), (1000, 1e-3))  # elements, step [s]
ALLOWED = 1e-4  # m rms
UNTIL, EVERY = 10.0, 0.05  # s


def reference() -> tuple[Floats, Floats, Floats]:
    """Times [s] and displacements [m] of the middle and the lower end by the other program."""
    time, middle, bottom = np.loadtxt(SERIES, delimiter=",", skiprows=5).T
    return time, middle, bottom


def rms(difference: Floats) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(difference**2)))


def _run() -> ComparisonReport:
    time, middle, bottom = reference()
    rows, last = [], middle
    for elements, step in RUNS:
        _, last, own_bottom = swing_sideways(Hanging(elements), step, UNTIL, EVERY)
        rows.append((elements, step, rms(last - middle), rms(own_bottom - bottom)))
    finest = rows[-1]
    comparisons = [
        pass_or_fail(
            "middle of the rope, rms over 10 s", f"under {1e3 * ALLOWED:g} mm", f"{1e3 * finest[2]:.4f} mm", finest[2] < ALLOWED
        ),
        pass_or_fail("lower end, rms over 10 s", f"under {1e3 * ALLOWED:g} mm", f"{1e3 * finest[3]:.5f} mm", finest[3] < ALLOWED),
    ]
    text = (
        "Rope of 50 m, 1.2 kg/m, EA 1e7 N, EI 20 N m², 60 kg free at the lower end, no damping; the upper end moves by 0.05 "
        "sin(2π 0.2 t) m. The other program used steps of 50 µs. The rope model always has a sheave, so a small driver "
        "uses the same kernels (tension, bending, tangent, elimination, Newmark's rule without numerical damping) with a "
        f"free end. Amplitude at the middle: {1e3 * np.abs(middle).max():.0f} mm."
    )
    numbers = [(f"{n}", f"{1e3 * h:g}", f"{1e3 * a:.4f}", f"{1e3 * b:.5f}") for n, h, a, b in rows]
    table = Table(
        ("elements", "step [ms]", "middle, rms [mm]", "lower end, rms [mm]"), numbers, "Difference from the other program"
    )
    return ComparisonReport(comparisons, [text, table, Picture("verify_reference", _draw(time, middle, last))])


def _draw(time: Floats, middle: Floats, own: Floats) -> Any:
    figure, (left, right) = panels(2)
    left.plot(time, 1e3 * middle, color=COLOURS[1], linewidth=3.0, label="other program")
    left.plot(time, 1e3 * own, color=COLOURS[0], linewidth=1.2, label="this one, 1000 elements, 1 ms")
    right.plot(time, 1e3 * (own - middle), color=COLOURS[0])
    label(left, "time [s]", "middle of the rope [mm]")
    label(right, "time [s]", "difference [mm]")
    left.set_ylim(top=145.0)  # room for the legend
    legend(left)
    return figure


CHECK = Check("reference", "Against another program: hanging rope with a free end", _run)
