"""Closed-form limit of friction on a sheave that does not turn, for a rope with bending stiffness: the capstan equation."""

from dataclasses import dataclass
from math import acos, pi, sin

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from comprope.rope.model_file import with_changes
from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope

from ...presets.paper_installations import TOWER, installation, jerk_limited_trip
from ...report.comparison_report import ComparisonReport
from ...report.page import Table
from ...vibration.prescribed_trip import simulate_trip
from .check import Check, pass_or_fail

FRICTION = (0.1, 0.2, 0.3)
STIFFNESSES = (2.0, 20.0)  # N m2
ALLOWED = 0.01  # of the ratio of tensions
HELD = {"effects.bearing_friction.coulomb_torque": 1000.0, "rope.bending_damping": 0.0}  # N m: the sheave does not turn
SPEED, ACCELERATION, JERK, ORIGIN, DISTANCE = 0.5, 0.4, 0.4, 20.0, 10.0  # of the car, up
FROM, UNTIL = 4.0, 6.0  # s, while the rope slides at constant speed


def closed_form(model: Base, low: float, speed: float = SPEED) -> float:
    """Tension [N] of the pulled side of a rope that slides round the sheave from the other side's, both at the axle's height.

    A free side under F leaves the groove, bent by 1 / R, at an angle theta to its pull: 1 - cos theta = EI / (2 R^2 F), by the
    energy of an elastica. There the groove carries the shear F sin theta as a point load, and its friction. In between
    T' = mu (T - rho v^2 - w sin psi) - w cos psi over the angle psi, w = rho g R; the wrap is pi less both angles.
    """
    radius, mu = model.sheave.radius, model.contact.friction_coefficient
    bend = model.rope.bending_stiffness / (2.0 * radius**2)
    weight = model.rope.mass_per_length * model.shaft.gravity * radius
    inertia = model.rope.mass_per_length * speed**2
    begin = acos(1.0 - bend / low)

    def excess(high: float) -> float:
        end = acos(1.0 - bend / high)
        wrap = solve_ivp(
            lambda psi, tension: mu * (tension - inertia - weight * np.sin(psi)) - weight * np.cos(psi),
            (begin, pi - end), [low - bend + mu * low * sin(begin)], rtol=1e-8,
        )  # fmt: skip
        return high - bend - mu * high * sin(end) - float(wrap.y[0, -1])

    return float(brentq(excess, low, 100.0 * low))


@dataclass(frozen=True)
class Row:
    """Friction coefficient, bending stiffness [N m2], and the ratio of tensions: obtained, closed form, without bending."""

    friction: float
    stiffness: float
    ratio: float
    form: float
    plain: float

    @property
    def error(self) -> float:
        """Difference from the closed form, relative to it."""
        return self.ratio / self.form - 1.0


def slide(friction: float, stiffness: float) -> Row:
    """Both tensions at the axle's height while the car pulls the rope over a sheave that is held."""
    changes = HELD | {"contact.friction_coefficient": friction, "rope.bending_stiffness": stiffness}
    model = with_changes(installation(TOWER), changes)
    rope, trip, seen = CompensationRope(model), jerk_limited_trip(DISTANCE, SPEED, ACCELERATION, JERK, ORIGIN), []
    per_metre = model.rope.mass_per_length * model.shaft.gravity
    for time in simulate_trip(rope, trip, UNTIL):
        if time >= FROM:
            now, car = rope.outputs(), trip.at(time).position
            axle = now["sheave_displacement"] - model.shaft.pit
            heights = (car - axle, model.shaft.height - car - axle)
            ends = (now["car_end_tension"], now["counterweight_end_tension"])
            seen.append([end - per_metre * height for end, height in zip(ends, heights, strict=True)])
    high, low = np.mean(seen, axis=0)
    return Row(friction, stiffness, float(high / low), closed_form(model, float(low)) / float(low), float(np.exp(friction * pi)))


def _run() -> ComparisonReport:
    rows = [slide(friction, stiffness) for friction in FRICTION for stiffness in STIFFNESSES]
    worst = max(abs(row.error) for row in rows)
    comparisons = [
        pass_or_fail(
            "ratio of tensions of a rope that slides / closed form",
            f"1 within {100 * ALLOWED:g} %",
            f"within {100 * worst:.2f} %",
            worst < ALLOWED,
        ),
    ]
    text = (
        "The car pulls the rope at 0.5 m/s over a sheave that a brake holds. Without bending and weight the tensions differ by "
        "the factor e^(mu pi). Bending lowers the tension on the groove by EI / (2 R^2) and shortens the wrap, at whose ends the "
        "groove carries the rope's shear. Both tensions are at the height of the axle."
    )
    head = ("friction", "EI [N m²]", "obtained", "closed form", "difference [%]", "without bending")
    numbers = [
        (f"{row.friction:g}", f"{row.stiffness:g}", f"{row.ratio:.4f}", f"{row.form:.4f}", f"{100 * row.error:+.2f}",
         f"{row.plain:.4f}")
        for row in rows
    ]  # fmt: skip
    return ComparisonReport(comparisons, [text, Table(head, numbers, "Ratio of the tensions on both sides, 50 m tower")])


CHECK = Check("capstan", "Closed form: capstan with bending", _run)
