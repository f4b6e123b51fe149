"""Closed-form solution for the lateral offset of a rope with bending stiffness leaving the sheave."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.side_shape import side_shape

from ...presets.paper_installations import TOWER, installation, sheave_changes
from ...report.comparison_report import ComparisonReport
from ...report.page import Picture, Table
from ...report.plot_style import COLOURS, label, legend, panels
from ...vibration.modal.hanging_string import side_string
from ...vibration.prescribed_trip import Floats
from .check import Check, pass_or_fail

STIFFNESSES = (5.0, 10.0, 20.0, 40.0)  # N m2
MASSES = (60.0, 120.0, 240.0)  # kg
HEIGHTS = np.array([0.5, 2.0, 5.0, 10.0, 20.0, 35.0])  # m
RIGID = {"contact.stiffness": 1e9, "rope.element_length": 0.0125}  # the groove and the mesh that the closed form means
ALLOWED = 0.005  # of the offset


def closed_form(model: Base, heights: Floats) -> Floats:
    """Outward displacement [m] at heights [m] of the counterweight's side at rest, car at the bottom landing.

    A rope of bending stiffness EI leaves a groove of radius r with its bend 1 / r, whence EI / (2 r T) from the
    plumb line, exact for tension T without weight; its own weight in the bend, of length (EI / T)^(1/2), takes a
    share rho g (EI / T)^(1/2) / (2 T) off. Above, T dy/dx is constant up to the end, where y = 0.
    """
    string = side_string(model, 0.0)
    weight, stiffness = string.mass_per_length * string.gravity, model.rope.bending_stiffness
    offset = stiffness / (2.0 * model.sheave.radius * string.tension)
    in_bend = weight * np.sqrt(stiffness / string.tension) / string.tension
    tension, end = string.tension + weight * (heights + model.shaft.pit), string.tension + weight * string.length
    return (1.0 - 0.5 * in_bend) * offset * np.log(end / tension) / np.log(end / string.tension)


def at_rest(model: Base) -> Floats:
    """The same from the model, at HEIGHTS."""
    rope = CompensationRope(model)
    rope.solve_equilibrium(0.0, model.shaft.height)
    return side_shape(rope, "counterweight", HEIGHTS)


@dataclass(frozen=True)
class Row:
    """Bending stiffness [N m2], sheave mass [kg]; displacements [m] at HEIGHTS: rigid groove, closed form, as the preset."""

    stiffness: float
    mass: float
    rigid: Floats
    form: Floats
    preset: Floats

    @property
    def worst(self) -> float:
        """The largest difference from the closed form, relative to it."""
        return float(np.abs(self.rigid / self.form - 1.0).max())


def _tower(stiffness: float, mass: float, changes: dict[str, float] | None = None) -> Base:
    """The tower with this bending stiffness [N m2] and sheave mass [kg]."""
    return installation(TOWER, sheave_changes(TOWER, mass) | {"rope.bending_stiffness": stiffness} | (changes or {}))


def _row(stiffness: float, mass: float) -> Row:
    model = _tower(stiffness, mass)
    return Row(stiffness, mass, at_rest(_tower(stiffness, mass, RIGID)), closed_form(model, HEIGHTS), at_rest(model))


def _run() -> ComparisonReport:
    rows = [_row(stiffness, mass) for mass in MASSES for stiffness in STIFFNESSES]
    worst = max(row.worst for row in rows)
    comparisons = [
        pass_or_fail(
            "displacement / closed form, rigid groove",
            f"1 within {100 * ALLOWED:g} %",
            f"within {100 * worst:.2f} %",
            worst < ALLOWED,
        ),
    ]
    text = (
        "The offset of a weightless rope leaving the groove is EI / (2 r T), for any slope at which it leaves. The weight of the "
        "rope increases the tension within the bend and above it, and the offset vanishes at the pinned end; the closed-form "
        "solution includes all three, to first order in the weight. It holds for a rigid groove and a fine mesh (1e9 "
        "N/m², 12.5 mm); the last column is for groove and mesh of the preset (1.2e7 N/m², 5 cm)."
    )
    numbers = [
        (f"{row.stiffness:g}", f"{row.mass:g}", f"{1e3 * row.rigid[0]:.3f}", f"{1e3 * row.form[0]:.3f}", f"{100 * row.worst:.3f}",
         f"{100 * (row.preset[0] / row.form[0] - 1.0):+.2f}")
        for row in rows
    ]  # fmt: skip
    head = (
        "EI [N m²]",
        "sheave [kg]",
        "model [mm]",
        "closed form [mm]",
        "largest difference, all heights [%]",
        "preset's groove and mesh [%]",
    )
    table = Table(head, numbers, "Outward displacement 2 m above the axle, 50 m tower, car at the bottom")
    return ComparisonReport(comparisons, [text, Picture("verify_offset", _draw(rows)), table])


def _draw(rows: list[Row]) -> Any:
    figure, (axes,) = panels()
    heights = np.linspace(HEIGHTS[0], HEIGHTS[-1], 100)
    for k, row in enumerate(row for row in rows if row.mass == MASSES[1]):
        form = closed_form(_tower(row.stiffness, row.mass), heights)
        axes.plot(1e3 * form, heights, "-", color=COLOURS[k], label=f"EI {row.stiffness:g} N m²")
        axes.plot(1e3 * row.rigid, HEIGHTS, "o", color=COLOURS[k], markersize=4)
    label(axes, "outward displacement [mm]", "height [m]", f"{MASSES[1]:g} kg; dots: model, lines: closed form")
    legend(axes)
    return figure


CHECK = Check("offset", "Closed form: static lateral offset", _run)
