"""Fig. 4: the static displacement over the weight of the sheave."""

from typing import Any

import numpy as np

from comprope.rope.simulator.rope import CompensationRope

from ...parallel.sweep import Case
from ...presets.paper_installations import TOWER, installation, model_of_case, sheave_changes, table
from ...report.comparison_report import Comparison, ComparisonReport
from ...report.page import Picture, Table
from ...report.plot_style import COLOURS, GREY, label, legend, panels, plain_log
from ...vibration.prescribed_trip import Floats
from .study import AGREES, DIFFERS, Study, StudyOptions

FRACTIONS = (0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.75, 0.8, 0.9, 1.0)  # of the nominal weight
PLACES = (("counterweight", 0.5), ("car", 0.5), ("counterweight", 10.0))  # side, height [m]
CAR = 25.0  # m, half-way up: both sides hang free over the same length
SMALL = 0.05  # of the largest relative displacement: "close to zero"


def _cases(_: StudyOptions) -> list[Case]:
    nominal = installation(TOWER).sheave.mass
    return [{"model": table(TOWER, sheave_changes(TOWER, fraction * nominal))} for fraction in FRACTIONS]


def static_offset(case: Case) -> list[float]:
    """Outward displacements [m] at PLACES of the rope at rest."""
    model = model_of_case(case)
    rope = CompensationRope(model)
    rope.solve_equilibrium(CAR, model.shaft.height - CAR)
    return [rope.lateral_displacement(side, height)[0] for side, height in PLACES]


def relative(offsets: Floats) -> Floats:
    """Displacements (weights, places) less that under the nominal weight (last row), over the largest, as in Fig. 4."""
    from_nominal = offsets - offsets[-1]
    return from_nominal / np.abs(from_nominal).max(axis=0)


def wrap_limit() -> float:
    """The fraction of the nominal weight below which the rope does not wrap the sheave: T < EI / (2 r^2)."""
    model = installation(TOWER)
    return model.rope.bending_stiffness / model.sheave.radius**2 / (model.shaft.gravity * model.sheave.mass)


def _evaluate(_: StudyOptions, values: list[Any]) -> ComparisonReport:
    weights, offsets = np.array(FRACTIONS), np.array(values)
    shown = relative(offsets)[:, 0]
    at_75 = float(np.interp(0.75, weights, shown))
    above = float(shown[weights >= 0.75].max())
    falls = bool(np.all(np.diff(offsets[:, 0]) < 0.0))
    boundary = float(np.interp(-SMALL, -shown, weights))
    comparisons = [
        Comparison(
            "relative displacement from 75 % of the nominal weight on",
            "close to zero",
            f"{100 * above:.1f} % of the largest at most",
            AGREES if above < SMALL else DIFFERS,
        ),
        Comparison(
            "below 75 %",
            "gets larger",
            "increases monotonically with decreasing weight" if falls else "does not increase monotonically",
            AGREES if falls else DIFFERS,
        ),
        Comparison(
            "boundary weight",
            "75 % of the nominal",
            f"{100 * boundary:.0f} % for {100 * SMALL:.0f} % of the largest displacement; the curve is smooth, without a kink",
            AGREES if 0.6 < boundary < 0.8 else DIFFERS,
        ),
    ]
    text = (
        "Rope and sheave of the 50 m tower at rest, car half-way up, sheave mass from 10 % to 100 % of 120 kg. Shown as in "
        "the paper: the displacement minus that at the nominal weight, divided by the largest. Far from the limit of "
        "wrapping, the displacement is about EI / (2 r T), proportional to 1 / weight, so that the normalised curve hardly "
        f"depends on the rope's bending stiffness, which the paper does not state. At 75 % it is {100 * at_75:.1f} % of that "
        "at 10 %, the smallest one computed; the smallest one of the paper is not stated, and with a larger one the value at "
        f"75 % is larger. Below {100 * wrap_limit():.0f} % of the nominal weight this rope no longer wraps the sheave and "
        "hangs as a free loop. With the car half-way up the two sides are mirror images."
    )
    return ComparisonReport(
        comparisons, [text, Picture("fig4_static_displacement", _draw(weights, offsets)), _numbers(weights, offsets)]
    )


def _numbers(weights: Floats, offsets: Floats) -> Table:
    head = ("weight / nominal", *(f"{side}, {height:g} m [mm]" for side, height in PLACES), "relative, normalised")
    rows = [
        (f"{weight:.2f}", *(f"{1e3 * one:.2f}" for one in row), f"{share:.3f}")
        for weight, row, share in zip(weights, offsets, relative(offsets)[:, 0], strict=True)
    ]
    return Table(head, rows, "Outward displacement at rest from the vertical through the sheave's side")


def _draw(weights: Floats, offsets: Floats) -> Any:
    figure, (left, right) = panels(2)
    styles = ("o-", "x--", "s-")
    for k, (side, height) in enumerate(PLACES):
        left.plot(weights, relative(offsets)[:, k], styles[k], color=COLOURS[k], markersize=4, label=f"{side}, {height:g} m")
        right.plot(weights, 1e3 * offsets[:, k], styles[k], color=COLOURS[k], markersize=4)
    model = installation(TOWER)
    tension = 0.5 * model.shaft.gravity * model.sheave.mass * weights
    right.plot(
        weights,
        1e3 * model.rope.bending_stiffness / (2.0 * model.sheave.radius * tension),
        ":",
        color="black",
        label="EI / (2 r T)",
    )
    for axes in (left, right):
        axes.axvline(0.75, color=GREY, linewidth=0.9)
    label(left, "sheave weight / nominal", "relative displacement / largest", "as in Fig. 4")
    label(right, "sheave weight / nominal", "outward displacement [mm]", "not normalised")
    right.set_yscale("log")
    plain_log(right.yaxis)
    legend(left)
    legend(right)
    return figure


STUDY = Study(
    "fig4",
    "Fig. 4: static displacement versus sheave weight",
    "The relative displacement is close to zero beyond 75 % of the nominal weight. … If the sheave weight is less than 75 % "
    "of the nominal weight, the relative displacement gets larger due to the bending force.",
    _cases,
    static_offset,
    _evaluate,
)
